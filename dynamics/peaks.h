#pragma once

#include <Eigen/Core>
#include <initializer_list>

#include "dynamics/figures.h"

namespace annulus::dynamics {

/// Largest value of a sampled curve: as sampled, and at the top of the parabola through the highest sample and its
/// neighbours. Their difference tells what the sampling misses.
struct Peak {
  double sampled = 0, refined = 0;
};
[[nodiscard]] Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values);
/// Highest peak over the rows of a matrix of curves x times.
[[nodiscard]] Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values);

/// The refined peak with the sum of what the sampling misses and of the differences to other runs: these are
/// independent causes that may add up.
[[nodiscard]] Figure figure(const Peak& best, std::initializer_list<Peak> others);

}  // namespace annulus::dynamics
