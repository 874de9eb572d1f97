#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <vector>

#include "core/figure.h"

namespace annulus::dynamics {

/// Largest value of a sampled curve: as sampled, and at the top of the parabola through the highest sample and its
/// neighbours. Their difference tells what the sampling misses.
struct Peak {
  double sampled = 0, refined = 0;
};
[[nodiscard]] Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values);
/// The same of a curve that jumps right before the samples `after_jump` (rising) or on them: no parabola reaches across
/// a jump. The values at the jumps themselves are the caller's to add.
[[nodiscard]] Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values,
                           const std::vector<Eigen::Index>& after_jump);
/// Highest peak over the rows of a matrix of curves x times.
[[nodiscard]] Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values,
                                const std::vector<Eigen::Index>& after_jump = {});

/// The refined peak with the sum of what the sampling misses and of the differences to other runs: these are
/// independent causes that may add up.
[[nodiscard]] Figure figure(const Peak& best, std::initializer_list<Peak> others);

}  // namespace annulus::dynamics
