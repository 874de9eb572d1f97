#pragma once

#include <Eigen/Core>

namespace annulus::dynamics {

/// Second derivatives of an energy at rest, by central differences over `step`.
template <class Energy>
Eigen::MatrixXd second_derivatives(const Energy& energy, const Eigen::VectorXd& step) {
  const Eigen::Index size = step.size();
  Eigen::MatrixXd k(size, size);
  const auto at = [&](Eigen::Index i, double a, Eigen::Index j, double b) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(size);
    q[i] += a * step[i];
    q[j] += b * step[j];
    return energy(q);
  };
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      k(i, j) = k(j, i) =
          (at(i, 1, j, 1) - at(i, 1, j, -1) - at(i, -1, j, 1) + at(i, -1, j, -1)) / (4 * step[i] * step[j]);
  return k;
}

}  // namespace annulus::dynamics
