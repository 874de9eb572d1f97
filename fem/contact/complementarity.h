#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::fem {

/// The contact conditions of one position (Karush-Kuhn-Tucker conditions of a convex quadratic programme):
///
///     w = C f + g - E lambda,   E^T f = t
///     unilateral: f >= 0, w >= 0, f w = 0        bilateral: w = 0
///
/// f are forces (pressed together > 0), w gaps after deformation, g gaps before, lambda rigid motions (transmission
/// error, motion of a floating ring), t the loads that belong to them.
struct ComplementarityProblem {
  Eigen::MatrixXd compliance;     ///< C, n x n, symmetric positive definite on the null space of E^T
  Eigen::VectorXd gap;            ///< g, n
  Eigen::MatrixXd rigid;          ///< E, n x r
  Eigen::VectorXd load;           ///< t, r
  std::vector<bool> unilateral;   ///< n
  Eigen::VectorXd applied_gap{};  ///< part of g by displacements under applied forces; empty without
};

struct ComplementaritySolution {
  Eigen::VectorXd force;  ///< f
  Eigen::VectorXd gap;    ///< w
  Eigen::VectorXd rigid;  ///< lambda
  /// d lambda / d t for the final contact set: its first diagonal entry is the tangent compliance.
  Eigen::MatrixXd tangent;
  std::vector<bool> active;
  int iterations = 0;
};

/// Primal-dual active sets (terminates exactly, when the set repeats); where the sets cycle, a primal active-set
/// method. `start`: guess of the active set, may be empty. Throws SolverError when the set does not settle.
[[nodiscard]] ComplementaritySolution solve_complementarity(const ComplementarityProblem& problem,
                                                            std::vector<bool> start);

}  // namespace annulus::fem
