#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/planetary_stage.h"

namespace annulus::dynamics {

/// A figure of merit with its estimated absolute numerical error.
struct Figure {
  double value = 0;
  double error = 0;
};

/// N F_n / sum F, its maximum over the planets n and over ...
struct LoadSharing {
  Figure instantaneous;  ///< ... every instant
  Figure averaged;       ///< ... every mesh cycle, the forces averaged over it first
  Figure quasi_static;   ///< ... every position, without inertia and damping
};

/// Largest N F_n / sum F over all columns; `force` has one row per planet. Infinite when a sum is not positive: the
/// stage carries no load at that instant and its share is unbounded.
[[nodiscard]] double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force);
/// The same after a running mean over `samples_per_cycle` columns.
[[nodiscard]] double load_sharing_averaged(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle);
/// N F_n / sum F over time, one row per planet.
[[nodiscard]] Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force);

/// Amplitudes of a real periodic series whose columns span whole mesh cycles.
struct Spectrum {
  Eigen::VectorXd order;      ///< multiples of the mesh frequency
  Eigen::VectorXd amplitude;  ///< single-sided; order 0 is the mean
};
[[nodiscard]] Spectrum spectrum(const Eigen::Ref<const Eigen::VectorXd>& series, int mesh_cycles);

/// A line of a spectrum, read as a sideband of the nearest multiple of the mesh frequency.
struct SpectralLine {
  double order = 0, amplitude = 0;
  int harmonic = 0;     ///< nearest whole order
  double sideband = 0;  ///< order - harmonic, in mesh orders; x z_r it counts turns of the carrier
};
/// The `count` highest lines but the mean, highest first, none below `floor` times the highest.
[[nodiscard]] std::vector<SpectralLine> highest_lines(const Spectrum& spectrum, int count, double floor = 1e-3);

/// Quasi-static mesh forces: K q + sum b k g(b^T q - e(t)) = f at equidistant positions from time 0 on, over the error
/// period or the first `max_cycles` mesh cycles of it.
struct QuasiStatic {
  Eigen::MatrixXd sun_force, ring_force;  ///< N, one row per planet, one column per position
};
/// Throws InputError for an unbalanced load, SolverError when the contact state is not found.
[[nodiscard]] QuasiStatic quasi_static(const PlanetaryStage& stage, int positions_per_cycle = 16,
                                       int max_cycles = 1000);

}  // namespace annulus::dynamics
