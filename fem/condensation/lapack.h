#pragma once

#include <Eigen/Core>
#include <complex>
#include <utility>

namespace annulus::fem::lapack {

/// Dense kernels handed to the optimised BLAS/LAPACK (OpenBLAS): Eigen's own are several times slower without
/// machine-specific compiler flags. Sizes are checked by the callers; all matrices are column-major.

/// In-place Cholesky factor L (lower) of a symmetric or Hermitian positive definite matrix; false when it is not.
[[nodiscard]] bool cholesky(Eigen::MatrixXd& matrix);
[[nodiscard]] bool cholesky(Eigen::MatrixXcd& matrix);
/// The full inverse from such a factor, in place.
void invert_from_cholesky(Eigen::MatrixXcd& factor);
/// rhs <- L^-1 rhs
void solve_lower(const Eigen::MatrixXd& factor, Eigen::MatrixXd& rhs);
void solve_lower(const Eigen::MatrixXcd& factor, Eigen::MatrixXcd& rhs);
/// a^T b
[[nodiscard]] Eigen::MatrixXd transpose_product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                const Eigen::Ref<const Eigen::MatrixXd>& b);
[[nodiscard]] Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                      const Eigen::Ref<const Eigen::MatrixXd>& b);
/// c <- c + a b
void add_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& c);
/// y^T y, both triangles filled.
[[nodiscard]] Eigen::MatrixXd gram(const Eigen::MatrixXd& y);
/// The `count` largest eigenvalues, falling, and their eigenvectors (orthonormal columns) of a symmetric matrix. Throws
/// SolverError when they do not converge.
[[nodiscard]] std::pair<Eigen::VectorXd, Eigen::MatrixXd> largest_eigenpairs(Eigen::MatrixXd matrix, int count);
/// One thread for what this thread calls of BLAS and CHOLMOD: annulus runs its own threads over independent tasks, and
/// starting threads for the small loops of a factorisation costs more than they do.
void use_one_thread();

}  // namespace annulus::fem::lapack
