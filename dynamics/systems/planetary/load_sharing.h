#pragma once

#include <Eigen/Core>

#include "core/figure.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// N F_n / sum F, its maximum over the planets n and over ...
struct LoadSharing {
  Figure instantaneous;  ///< ... every instant
  Figure averaged;       ///< ... every mesh cycle, the forces averaged over it first
  Figure quasi_static;   ///< ... every position, without inertia and damping
};

/// Largest N F_n / sum F over all columns; `force` (N) has one row per planet. Infinite when a sum is not positive: the
/// stage then carries no load at that instant.
[[nodiscard]] double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force);
/// The same after a running mean over `samples_per_cycle` columns.
[[nodiscard]] double load_sharing_averaged(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle);
/// N F_n / sum F over time, one row per planet.
[[nodiscard]] Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force);

/// Quasi-static mesh forces: K q + sum b k g(b^T q - e(t)) = f at equidistant positions from time 0 on. They span the
/// error period or its first `max_cycles` mesh cycles.
struct QuasiStatic {
  Eigen::MatrixXd sun_force, ring_force;  ///< N, one row per planet, one column per position
};
/// Throws InputError for an unbalanced load, SolverError when the contact state is not found.
[[nodiscard]] QuasiStatic quasi_static(const PlanetaryStage& stage, int positions_per_cycle = 16,
                                       int max_cycles = 1000);

}  // namespace annulus::dynamics
