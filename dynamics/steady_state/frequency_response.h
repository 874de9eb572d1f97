#pragma once

#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The system with constant mesh stiffnesses k and all mesh dampers acting, in the frequency domain:
///   D(w) = -w^2 M + i w (C + G + sum c b b^T) + K + K_Omega + sum k b b^T.
/// The eigenvalues of its state matrix give thousands of lines at little cost. They are compared with solutions of
/// D(w) x = b at a few frequencies. Such solutions replace them where eigenvectors are useless because eigenvalues
/// coincide (critical damping).
///
/// Rigid motions, which K and the meshes do not resist, have no definite position. At w = 0 they are fixed by
/// nu^T M q = 0, as in StaticSolver. The small effect of K_Omega on them (a body out of balance) is neglected.
class FrequencyResponse {
 public:
  /// `mesh_stiffness`: N/m, one per mesh. Throws SolverError when the system is singular at w = 0.
  FrequencyResponse(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

  /// Transfer B^T D(w)^-1 B (m/N) from mesh forces to approaches at some `rates` w (rad/s), none of them 0. Shape:
  /// meshes x (2 meshes rates), per rate the real part beside the imaginary part.
  [[nodiscard]] Eigen::MatrixXd mesh_transfer(const Eigen::VectorXd& rates) const;

  /// Displacements D(w)^-1 B F (m, DOFs x rates) at such rates, from amplitudes F (N, meshes x rates).
  [[nodiscard]] Eigen::MatrixXcd displacements(const Eigen::VectorXd& rates, const Eigen::MatrixXcd& forces) const;

  /// D(0)^-1 f (m, one per DOF) for a real force f (N, one per DOF) that does no work on rigid motions.
  [[nodiscard]] Eigen::VectorXd static_displacement(const Eigen::VectorXd& force) const;

  /// D(w)^-1 f (m, one per DOF) for the complex amplitude f (N, one per DOF) of a force with the rate w (rad/s), not 0.
  [[nodiscard]] Eigen::VectorXcd displacement(double rate, const Eigen::VectorXcd& force) const;

  /// Mesh vectors b as columns.
  [[nodiscard]] const Eigen::MatrixXd& mesh_vectors() const { return b_; }
  [[nodiscard]] bool by_eigenvalues() const { return by_eigenvalues_; }
  /// Highest undamped natural frequency, rad/s.
  [[nodiscard]] double highest_rate() const { return highest_rate_; }

 private:
  [[nodiscard]] Eigen::MatrixXcd dynamic_stiffness(double rate) const;  // D
  [[nodiscard]] Eigen::MatrixXcd solve_directly(double rate) const;     // D^-1 B
  [[nodiscard]] Eigen::MatrixXd transfer_by_eigenvalues(const Eigen::VectorXd& rates) const;
  void find_eigenvalues(const Eigen::MatrixXd& shapes, Eigen::Index rigid_motions);
  [[nodiscard]] bool eigenvalues_agree() const;

  Eigen::MatrixXd mass_, damping_, stiffness_, b_;
  Eigen::MatrixXd static_inverse_;
  bool by_eigenvalues_ = false;
  double highest_rate_ = 0;
  Eigen::VectorXcd eigenvalues_;  // 1/s
  Eigen::MatrixXcd inputs_;       // eigenvalues x meshes
  Eigen::MatrixXcd outputs_;      // DOFs x eigenvalues, rigid displacements left out
  Eigen::MatrixXcd rigid_rates_;  // DOFs x eigenvalues: velocities along the rigid motions
};

}  // namespace annulus::dynamics
