#pragma once

#include <Eigen/Core>

namespace annulus::dynamics {

/// Functions of two angles: samples of the first one at a number of values (rows, odd) of the second one, row behind
/// row. Matrices have one column per function. In the second angle they are trigonometric polynomials through the rows.

/// The values at `count` times from 0, one step of the first angle apart, in which the second one advances by `advance`
/// (rad).
[[nodiscard]] Eigen::MatrixXd along_both_angles(const Eigen::MatrixXd& values, int rows, double advance,
                                                Eigen::Index count);
/// The same functions at another number of rows.
[[nodiscard]] Eigen::MatrixXd at_rows(const Eigen::MatrixXd& values, int rows, int wanted);

}  // namespace annulus::dynamics
