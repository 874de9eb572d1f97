#pragma once

#include <Eigen/Core>

#include "dynamics/statics/meshed_stiffness.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Equilibrium without inertia, damping and rotation: K q + sum_m b_m F_m(t, b_m^T q - e_m(t)) = f(t), where F_m is
/// the elastic force of a mesh (k g or its law).
///
/// Friction acts with the forces that it leads to.
///
/// Rigid motions (at mean mesh stiffness) are fixed by nu^T M q = 0, which needs no force because the constant part of
/// f does no work on them. What changes in time may: the inertia of the rigid motion then balances it.
class StaticSolver {
 public:
  /// Throws InputError when the constant load does work on a rigid motion, which no support would resist.
  explicit StaticSolver(const LumpedSystem& system);

  /// Displacements (m, one per DOF) in equilibrium at time t (s). The iteration starts from the contact states in
  /// `workspace` and leaves delta, force (without damping) and contact of the solution there. Throws SolverError when
  /// the contact state or, with a law, the equilibrium is not found.
  [[nodiscard]] Eigen::VectorXd solve(double t, LumpedSystem::Workspace& workspace);

  /// d forces / d errors of the meshes at the solution that `solve` has just left in `workspace`, N/m, meshes x meshes.
  /// Throws SolverError where the stiffness is not positive.
  [[nodiscard]] Eigen::MatrixXd force_per_error(const LumpedSystem::Workspace& workspace);

 private:
  /// `mean`: N/m, of the stiffnesses of the meshes.
  StaticSolver(const LumpedSystem& system, const Eigen::VectorXd& mean);
  /// Equilibrium at time t under `load_`, from the contact states in the workspace, which are updated.
  Eigen::VectorXd equilibrium(double t, LumpedSystem::Workspace& workspace);
  /// Equilibrium in the held contact state: one Newton step for linear meshes, a few steps with a law.
  void iterate(double t, Eigen::VectorXd& q, LumpedSystem::Workspace& workspace);
  /// f - K q - sum b F at q, and the size of its terms (the scale of its rounding). Evaluates the meshes.
  double residual(double t, const Eigen::VectorXd& q, LumpedSystem::Workspace& workspace);
  void factorise(const Eigen::MatrixXd& tangent, double t);
  /// Tangents of the meshes at the last evaluation, with the springs of open ones, into `tangent_`.
  void set_tangent(const LumpedSystem::Workspace& workspace);

  const LumpedSystem& system_;
  MeshedStiffness stiffness_;  // K with rigid motions fixed; mesh vectors b at the time as columns
  Eigen::MatrixXd tangent_;
  Eigen::MatrixXd stiffness_size_, vectors_size_;  // their amounts, for the rounding of the residual
  Eigen::VectorXd load_;                           // f at the time
  Eigen::VectorXd residual_, terms_, forces_, rest_, anchor_;
};

/// Equilibria at some times.
struct StaticPath {
  Eigen::MatrixXd displacement, force;  ///< m, DOFs x times; N, meshes x times
};
/// `times`: s, rising. Throws what StaticSolver throws.
[[nodiscard]] StaticPath static_path(const LumpedSystem& system, const Eigen::VectorXd& times);

}  // namespace annulus::dynamics
