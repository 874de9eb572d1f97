#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

/// Spectra of small real matrices, whose solvers take long to compile.
namespace annulus::dynamics {

/// Throws SolverError with `what` where the solver fails: "the Floquet multipliers".
[[nodiscard]] Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix, const std::string& what);

struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  ///< columns, of length one
};
/// Nothing where the solver fails.
[[nodiscard]] std::optional<Eigenpairs> eigenpairs(const Eigen::MatrixXd& matrix);

[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

}  // namespace annulus::dynamics
