#pragma once

#include <optional>
#include <vector>

#include "core/figure.h"
#include "dynamics/steady_state/periodic_response.h"
#include "dynamics/steady_state/piecewise_response.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/planetary/load_sharing.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// One branch of the power flow: the mesh of one planet with sun or ring.
struct BranchResult {
  Figure dynamic_factor_max;      ///< max F / mean mesh force over the window (peaks refined between the samples)
  double dynamic_factor_min = 0;  ///< min F / mean mesh force
  double mean_force = 0;          ///< N
  double contact_loss = 0;        ///< fraction of the time without contact
};

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
  TimeSeries series;
};

/// Periodic steady state of the stage and its results. Two independent methods, harmonic balance and time integration
/// over one window, confirm each other. Time integration goes on alone where they disagree, where no harmonic balance
/// is found or where the error period is longer than `max_window_cycles`.
///
/// The error of a result is the sum of the sampling error and the difference to the harmonic balance or the window
/// before. With `estimate_error` the difference to a looser integration is added. An infinite load sharing means
/// instants without load.
///
/// Throws InputError when the stage or the options are not usable (no speed, no torque, a load out of balance because
/// no support resists it), SolverError when the integrator fails.
[[nodiscard]] DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options = {});

/// Harmonic balance of the stage alone, over its error period. Throws InputError without a speed above zero.
[[nodiscard]] PeriodicResponse periodic_response(const PlanetaryStage& stage, const PeriodicOptions& options = {});
/// Exact solution of a stage with piecewise constant stiffness, over its error period. Throws InputError without a
/// speed above zero.
[[nodiscard]] PiecewiseResponse piecewise_response(const PlanetaryStage& stage, const PiecewiseOptions& options = {});

}  // namespace annulus::dynamics
