#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The mesh forces as functions of the approaches b^T q and their rates, at equidistant times of one period, with their
/// derivatives.
///
/// Where a stiffness jumps or contact changes between two samples, a sample stands for the mean over the time step
/// around it. Forces are then continuous in the approaches, and the sampling error falls with the square of the time
/// step instead of the time step. Coupled meshes are not averaged over contact changes.
///
/// Matrices: samples x meshes.
class SampledMeshes {
 public:
  SampledMeshes(const LumpedSystem& system, double period, Eigen::Index samples);

  [[nodiscard]] Eigen::Index samples() const { return samples_; }
  [[nodiscard]] double time(Eigen::Index sample) const { return static_cast<double>(sample) * step_; }
  /// Approaches (m) and rates (m/s) of deflections `delta` (m), one per mesh and the same at all times.
  void at_deflection(const Eigen::VectorXd& delta, Eigen::MatrixXd& approach, Eigen::MatrixXd& rate);

  /// Forces (N); stores their derivatives.
  void evaluate(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force);
  /// dF/d delta and dF/d delta' of the last evaluation.
  [[nodiscard]] const Eigen::MatrixXd& tangent() const { return tangent_; }
  [[nodiscard]] const Eigen::MatrixXd& damping() const { return damping_; }
  /// Change of the forces with the approaches, sample by sample, minus `mean` x change; coupled meshes included.
  void apply_tangent(const Eigen::Ref<const Eigen::MatrixXd>& change, const Eigen::VectorXd& mean,
                     Eigen::Ref<Eigen::MatrixXd> force) const;

  /// Forces (N) at the instants themselves (just after a jump), and the flanks that press, whatever the damping.
  void evaluate_at_instants(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force,
                            std::vector<LumpedSystem::Contact>& contact);

 private:
  struct Piece {
    double weight, middle;  // share of the time step, a time without jump inside it
  };
  void add_piece(Eigen::Index sample, const Piece& piece);
  void add_partial_contact(Eigen::Index sample, const Piece& piece, int side);

  const LumpedSystem& system_;
  LumpedSystem::Workspace workspace_;
  Eigen::Index samples_ = 0;
  double step_ = 0;
  std::vector<std::vector<Piece>> pieces_;  // per sample; empty when no stiffness jumps
  Eigen::MatrixXd tangent_, damping_;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs_;  // the force of the first depends on the second
  Eigen::MatrixXd coupled_, block_;  // dF/d delta of the pairs, samples x pairs; meshes x meshes
  // Present sample, per mesh.
  Eigen::VectorXd approach_, rate_, moved_, force_;
  std::vector<char> whole_;  // the contact state does not change within the step
};

}  // namespace annulus::dynamics
