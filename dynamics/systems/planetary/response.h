#pragma once

#include <vector>

#include "dynamics/figures/mesh_results.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/systems/planetary/body_results.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

struct MeshKindResult {
  LoadSharing load_sharing;
  std::vector<BranchResult> branches;  ///< one per planet
};

struct DynamicResponse : SteadyOutcome {
  double mesh_frequency = 0;   ///< Hz
  double mean_mesh_force = 0;  ///< N, T_s / (N r_bs)
  MeshKindResult sun_planet, ring_planet;
  Eigen::MatrixXd cycle_force;  ///< N, forces averaged over each mesh cycle: sun meshes, then ring meshes x cycles
  /// Momentum balance of the sun's rotation over the window, relative to T_s: mean of sum F_sn r_bs (and of its
  /// torsional support, and the change of angular momentum) against T_s.
  double force_balance_relative = 0;
  FigureSet bodies;  ///< body_results()
  std::vector<ShaftResult> shafts;
  TimeSeries series;
};

/// Periodic steady state of the stage and its results. Two independent methods, harmonic balance and time integration
/// over one window, confirm each other. Time integration goes on alone where they disagree, where no harmonic balance
/// is found or where the error period is longer than `max_window_cycles`.
///
/// The error of a result is the sum of the sampling error and the difference to the harmonic balance or the window
/// before. With `estimate_error` the difference to a looser integration (to half of the fixed steps) is added. An
/// infinite load sharing means instants without load.
///
/// Throws InputError when the stage or the options are not usable (no speed, no torque, a load out of balance because
/// no support resists it, small motions that grow), SolverError when the integrator fails.
[[nodiscard]] DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options = {});
/// The system that it solves. Throws InputError when the stage is not usable.
[[nodiscard]] LumpedCase lumped_case(const PlanetaryStage& stage);

/// Quasi-static mesh forces: K q + sum b k g(b^T q - e(t)) = f at equidistant positions from time 0 on. They span the
/// error period or its first `max_cycles` mesh cycles.
struct QuasiStatic {
  Eigen::MatrixXd sun_force, ring_force;  ///< N, one row per planet, one column per position
};
/// Throws InputError for an unbalanced load, SolverError when the contact state is not found.
[[nodiscard]] QuasiStatic quasi_static(const PlanetaryStage& stage, int positions_per_cycle = 16,
                                       int max_cycles = 1000);

}  // namespace annulus::dynamics
