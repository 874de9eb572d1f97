#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::dynamics {

/// Samples of one window: meshes (and DOFs) x times.
struct ResponseWindow {
  int samples_per_cycle = 0;
  Eigen::VectorXd time;
  Eigen::MatrixXd force, displacement, velocity;
  Eigen::VectorXd open;  ///< fraction of the samples without contact, per mesh

  /// Where stiffnesses jump (empty otherwise), from the beginning of the window to before its end: the forces on both
  /// sides, meshes x jumps, and the samples right after a jump, at or behind it. Extremes stand at the jumps, and
  /// curves do not go on smoothly across. The beginning is always among them: there the end of the window is followed
  /// by its beginning.
  Eigen::VectorXd jump_time{};
  Eigen::MatrixXd force_before{}, force_after{};
  std::vector<Eigen::Index> after_jump{};

  /// Forces at closer times, over as much of the window as shows everything (empty: there are none): peaks are then
  /// taken from here; and its samples right after a jump.
  Eigen::MatrixXd dense_force{};
  std::vector<Eigen::Index> dense_after_jump{};

  [[nodiscard]] bool jumps() const { return jump_time.size() > 0; }
};

/// The forces for averages, meshes x times: the mean over whole mesh cycles is that of the trapezoidal rule, which at a
/// jump between two samples takes each side up to the jump. A plain mean of samples is wrong there by up to half the
/// jump over the samples of a cycle.
[[nodiscard]] Eigen::MatrixXd averaging_force(const ResponseWindow& window);

}  // namespace annulus::dynamics
