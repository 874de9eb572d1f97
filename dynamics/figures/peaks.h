#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <vector>

#include "core/figure.h"

namespace annulus::dynamics {

/// Largest value of a sampled curve: as sampled, and at the top of the parabola through the highest sample and its
/// neighbours. Their difference estimates the error of the sampling.
struct Peak {
  double sampled = 0, refined = 0;
};
[[nodiscard]] Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values);
/// The same for a curve that jumps right before the samples `after_jump` (rising) or on them: no parabola reaches
/// across a jump. The caller adds the values at the jumps themselves.
[[nodiscard]] Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values,
                           const std::vector<Eigen::Index>& after_jump);
/// Highest peak over the rows of a matrix of curves x times.
[[nodiscard]] Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values,
                                const std::vector<Eigen::Index>& after_jump = {});

/// The higher one of two, each sampled and refined by itself.
[[nodiscard]] Peak higher(const Peak& a, const Peak& b);
[[nodiscard]] Peak operator+(const Peak& a, const Peak& b);
[[nodiscard]] Peak operator/(const Peak& peak, double scale);
/// Largest less smallest value of a curve.
[[nodiscard]] Peak swing_of(const Eigen::Ref<const Eigen::RowVectorXd>& values);

/// The refined peak. Its error is the sum of the sampling error and the differences to other runs: independent causes
/// that may add up.
[[nodiscard]] Figure figure(const Peak& best, std::initializer_list<Peak> others);

}  // namespace annulus::dynamics
