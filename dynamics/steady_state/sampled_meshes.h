#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The mesh forces as functions of the closings b^T q and their rates, at equidistant times of one period, with their
/// derivatives. Where a stiffness jumps or teeth meet or part between two samples, a sample stands for the mean over
/// the time step around it: forces are then continuous in the closings, and the error of the sampling goes down with
/// the square of the time step instead of the time step. (Meshes that are coupled are not averaged over contact
/// changes.)
///
/// Matrices: samples x meshes.
class SampledMeshes {
 public:
  SampledMeshes(const LumpedSystem& system, double period, Eigen::Index samples);

  [[nodiscard]] Eigen::Index samples() const { return samples_; }
  [[nodiscard]] double time(Eigen::Index sample) const { return static_cast<double>(sample) * step_; }
  /// Transmission errors and their rates, and (through `tangent`) the derivatives dF/d delta at deflections `delta`,
  /// one per mesh and the same at all times.
  void at_deflection(const Eigen::VectorXd& delta, Eigen::MatrixXd& closing, Eigen::MatrixXd& rate);

  /// Forces; remembers their derivatives.
  void evaluate(const Eigen::MatrixXd& closing, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force);
  /// dF/d delta and dF/d delta' of the last evaluation.
  [[nodiscard]] const Eigen::MatrixXd& tangent() const { return tangent_; }
  [[nodiscard]] const Eigen::MatrixXd& damping() const { return damping_; }
  /// Change of the forces with the closings, sample by sample, less `mean` x change; couplings included.
  void apply_tangent(const Eigen::Ref<const Eigen::MatrixXd>& change, const Eigen::VectorXd& mean,
                     Eigen::Ref<Eigen::MatrixXd> force) const;

  /// Forces at the very instants (just after a jump), and the contact states.
  void evaluate_at_instants(const Eigen::MatrixXd& closing, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force,
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
  Eigen::MatrixXd coupled_, block_;  // with couplings: meshes x (meshes samples), one block per sample
  // Of the sample in work, per mesh.
  Eigen::VectorXd closing_, rate_, moved_, force_;
  std::vector<char> whole_;  // the contact state does not change within the step
};

}  // namespace annulus::dynamics
