#include "dynamics/modes/dense_spectrum.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/errors.h"

namespace annulus::dynamics {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix, const std::string& what) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success)
    throw SolverError(fmt::format("{} of {} state variables were not found", what, matrix.rows()));
  return solver.eigenvalues();
}

std::optional<Eigenpairs> eigenpairs(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Eigenpairs{solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix) { return matrix.exp(); }

}  // namespace annulus::dynamics
