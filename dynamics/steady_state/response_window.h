#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::dynamics {

/// Samples of one window: force in N, meshes x times; displacement and velocity in m and m/s, DOFs x times.
struct ResponseWindow {
  int samples_per_cycle = 0;
  Eigen::VectorXd time;
  Eigen::MatrixXd force, displacement, velocity;
  Eigen::VectorXd open;  ///< fraction of the samples without contact, per mesh
  Eigen::VectorXd back;  ///< fraction of the samples at which back flanks press, per mesh

  /// Jumps of stiffnesses from the beginning of the window to before its end; empty without jumps. Times (s), forces on
  /// both sides (N, meshes x jumps) and the samples at or right after a jump. Extremes occur at jumps, and curves are
  /// not smooth across them. The beginning is always a jump: there the end of the window is followed by its beginning.
  Eigen::VectorXd jump_time{};
  Eigen::MatrixXd force_before{}, force_after{};
  std::vector<Eigen::Index> after_jump{};

  /// Forces at closer times over the window or one period of it, for peaks, and their samples right after a jump. May
  /// be empty. `dense_per_sample` of them for every sample, from time[0] on.
  Eigen::MatrixXd dense_force{};
  int dense_per_sample = 1;
  std::vector<Eigen::Index> dense_after_jump{};

  [[nodiscard]] bool jumps() const { return jump_time.size() > 0; }
};

/// Forces for averages (N, meshes x times). Their mean over whole mesh cycles is that of the trapezoidal rule, which at
/// a jump between two samples takes each side up to the jump. A plain mean of samples would be wrong by up to half the
/// jump divided by the samples of a cycle.
[[nodiscard]] Eigen::MatrixXd averaging_force(const ResponseWindow& window);

}  // namespace annulus::dynamics
