#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace annulus::fem {

/// A stiffness matrix and loads condensed to some of the DOFs, r; the others, i, are eliminated.
struct SchurComplement {
  Eigen::MatrixXd matrix;      ///< K_rr - K_ri K_ii^-1 K_ir
  Eigen::MatrixXd loads;       ///< b_r - K_ri K_ii^-1 b_i, one column per load
  Eigen::MatrixXd compliance;  ///< b_i^T K_ii^-1 b_i, loads x acting loads: the retained DOFs are held
};

/// Condenses to the retained DOFs, in the order given.
///
/// They are eliminated last, so that the trailing block of one sparse factorisation is the Cholesky factor of the
/// complement: exact, and cheaper than solving for every retained column. Loads take part through forward solves with
/// the same factor, a few columns at a time; of their compliance only the columns of the first `acting` are formed (the
/// others are observed, never applied).
/// Throws SolverError when the matrix is not positive definite. A complement that is itself singular (a body that can
/// still move rigidly) is allowed when `shift_retained` > 0: that multiple of the identity is added to the retained
/// block before the factorisation and taken off the result.
[[nodiscard]] SchurComplement schur_complement(const Eigen::SparseMatrix<double>& matrix,
                                               const std::vector<int>& retained, double shift_retained = 0,
                                               const Eigen::SparseMatrix<double>& loads = {}, int acting = 0);

}  // namespace annulus::fem
