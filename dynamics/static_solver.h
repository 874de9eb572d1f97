#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "dynamics/lumped_system.h"

namespace annulus::dynamics {

/// Equilibrium without inertia, damping and rotation: K q + sum_m b_m k_m(t) g(b_m^T q - e_m(t)) = f.
/// Rigid motions (at mean mesh stiffness) are fixed by nu^T M q = 0, which costs no force because f does no work on
/// them.
class StaticSolver {
 public:
  /// Throws InputError when the load does work on a rigid motion: nothing would hold it.
  explicit StaticSolver(const LumpedSystem& system);

  /// Equilibrium at time t. `workspace` enters with the contact states to start from and leaves with delta, force
  /// (without damping) and contact at the solution. Throws SolverError when the contact state is not found.
  [[nodiscard]] Eigen::VectorXd solve(double t, LumpedSystem::Workspace& workspace);

 private:
  const LumpedSystem& system_;
  Eigen::MatrixXd base_, vectors_;  // K with the rigid motions held; mesh vectors b as columns
  Eigen::MatrixXd matrix_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace annulus::dynamics
