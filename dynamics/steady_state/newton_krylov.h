#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace annulus::dynamics {

/// A system of equations r(u) = 0 by its residual and derivative.
struct Equations {
  std::function<void(const Eigen::VectorXd& u, Eigen::VectorXd& residual)> residual;
  /// dr/du v at the last `residual`.
  std::function<void(const Eigen::VectorXd& v, Eigen::VectorXd& product)> derivative;
};

struct NewtonKrylovOptions {
  double tolerance = 1e-5;  ///< largest residual x `weight`
  double weight = 1;        ///< of unknowns and residuals
  int max_iterations = 20;
};

struct NewtonKrylovResult {
  Eigen::VectorXd u;    ///< the last iterate
  double residual = 0;  ///< of it, x weight; it was evaluated last
  bool converged = false;
  int newton_iterations = 0, linear_iterations = 0;
  std::string trouble;  ///< the cause where it did not converge
};

/// Newton's method with line search and GMRES (KINSOL) from `start`. With `max_iterations` 0 the residual of the start
/// alone is found. Throws what the equations throw.
[[nodiscard]] NewtonKrylovResult solve_newton_krylov(const Equations& equations, const Eigen::VectorXd& start,
                                                     const NewtonKrylovOptions& options);

}  // namespace annulus::dynamics
