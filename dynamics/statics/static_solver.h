#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Equilibrium without inertia, damping and rotation: K q + sum_m b_m F_m(t, b_m^T q - e_m(t)) = f, F_m the elastic
/// force of a mesh (k g or its law).
/// Rigid motions (at mean mesh stiffness) are fixed by nu^T M q = 0, which costs no force because f does no work on
/// them.
class StaticSolver {
 public:
  /// Throws InputError when the load does work on a rigid motion: nothing would hold it.
  explicit StaticSolver(const LumpedSystem& system);

  /// Equilibrium at time t. `workspace` enters with the contact states to start from and leaves with delta, force
  /// (without damping) and contact at the solution. Throws SolverError when the contact state or, with a law, the
  /// equilibrium is not found.
  [[nodiscard]] Eigen::VectorXd solve(double t, LumpedSystem::Workspace& workspace);

 private:
  /// The equilibrium in the held contact state: one step of Newton's method for linear meshes, a few with a law.
  void balance(double t, Eigen::VectorXd& q, LumpedSystem::Workspace& workspace);
  /// f - K q - sum b F at q, and the size of its terms (the scale of its rounding). Evaluates the meshes.
  double residual(double t, const Eigen::VectorXd& q, LumpedSystem::Workspace& workspace);
  void factorise(const Eigen::MatrixXd& tangent, double t);

  const LumpedSystem& system_;
  Eigen::MatrixXd base_, vectors_;  // K with the rigid motions held; mesh vectors b (at the time) as columns
  Eigen::MatrixXd tangent_;
  Eigen::MatrixXd base_size_;  // |K|, for the rounding of the residual
  Eigen::VectorXd residual_, terms_, forces_, rest_, anchor_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace annulus::dynamics
