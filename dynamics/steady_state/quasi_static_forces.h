#pragma once

#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Mesh forces (N, meshes x positions) in the static equilibria of `cycles` mesh cycles from time 0, at so many
/// positions of each. Where the excitation repeats after a long time only and has two angles (see two_frequencies), the
/// equilibria at few values of the second one stand for all, if they give the forces at every 31st position within 1e-4
/// of the largest force. Throws SolverError where there is no equilibrium.
[[nodiscard]] Eigen::MatrixXd quasi_static_forces(const LumpedSystem& system, double mesh_frequency, int cycles,
                                                  int positions_per_cycle);

}  // namespace annulus::dynamics
