#pragma once

#include <optional>
#include <vector>

#include "dynamics/figures.h"
#include "dynamics/planetary_stage.h"
#include "dynamics/steady_response.h"

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

struct DynamicResponse {
  double mesh_frequency = 0;        ///< Hz
  double mean_mesh_force = 0;       ///< N, T_s / (N r_bs)
  int window_cycles = 0;            ///< evaluated at the end, mesh cycles
  bool whole_error_period = false;  ///< false when `mesh_cycles` or `max_window_cycles` was too short for one
  int total_cycles = 0;             ///< integrated mesh cycles; 0: none, the harmonic balance alone
  bool steady = false;              ///< within steady_tolerance (see there), or taken from the harmonic balance alone
  bool confirmed = false;           ///< harmonic balance and time integration agree
  /// Largest mesh force difference to the harmonic balance (when `confirmed`) or to the window before / mean mesh
  /// force; absent when there was none to compare with.
  std::optional<double> steady_difference;
  std::optional<DirectSolution> direct;        ///< absent when only marching was asked for or possible
  std::optional<IntegratorChoice> integrator;  ///< present when it was left to the program and something was integrated
  MeshKindResult sun_planet, ring_planet;
  Eigen::MatrixXd cycle_force;  ///< N, forces averaged over each mesh cycle: sun meshes, then ring meshes x cycles
  EnergyBalance energy;
  /// Momentum balance of the sun's rotation over the window, relative to T_s: mean of sum F_sn r_bs (and of its
  /// torsional support, and the change of angular momentum) against T_s.
  double force_balance_relative = 0;
  IntegratorStatistics statistics;
  TimeSeries series;
};

/// Periodic steady state of the stage and its figures: solved for directly and confirmed by marching over one window
/// from there (two independent methods); where they disagree, no balance is found or the error period is longer than
/// `max_window_cycles`, by marching alone. The error of a figure adds up what the sampling misses, the change from the
/// harmonic balance or the window before and, with `estimate_error`, the change under a looser integration. An infinite
/// load sharing means instants at which the stage carries no load. Throws InputError when the stage or the options are
/// not usable (no speed, no torque, an unbalanced load: nothing holds the ring), SolverError when the integrator fails.
[[nodiscard]] DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options = {});

}  // namespace annulus::dynamics
