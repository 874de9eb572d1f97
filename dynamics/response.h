#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/figures.h"
#include "dynamics/integrate.h"
#include "dynamics/planetary_stage.h"

namespace annulus::dynamics {

struct SimulationOptions {
  IntegratorOptions integrator;
  /// Total mesh cycles from the start. Absent: until the response repeats, then one error period.
  std::optional<int> mesh_cycles;
  /// The response counts as periodic when no mesh force differs by more than this, relative to the mean mesh force,
  /// from one evaluated window earlier, and the differences, continued geometrically, add up to no more.
  double steady_tolerance = 1e-3;
  int max_windows = 40;        ///< gives up after so many windows (chaos, nearly undamped): `steady` is then false
  int samples_per_cycle = 64;  ///< of the time series; the highest excited frequency needs at least four samples
  /// The window is the error period, or as many error periods as reach this many mesh cycles: differences between
  /// short windows say little about slow transients.
  int min_window_cycles = 20;
  /// Upper limit of the window (memory): sun, planet and housing errors together repeat after lcm(z_s, z_p, z_r) mesh
  /// cycles, which may be tens of thousands. A window cut by it cannot be compared with the one before.
  int max_window_cycles = 1000;
  /// Integrates the last window again with a tolerance ten times looser to estimate the integrator's part of the error.
  bool estimate_error = true;
};

/// Time series over the evaluated window, equidistant, the end point not included.
struct TimeSeries {
  std::vector<std::string> freedoms;  ///< sun_x, planet1_u, ... (all are lengths, m)
  std::vector<std::string> meshes;    ///< sun_planet1 ... ring_planetN
  Eigen::VectorXd time;               ///< s
  Eigen::MatrixXd displacement;       ///< m, one row per freedom, one column per time; rigid rotation included
  Eigen::MatrixXd velocity;           ///< m/s
  Eigen::MatrixXd force;              ///< N, one row per mesh; positive pushes the teeth apart
};

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

/// Energy bookkeeping over the window: change of energy = supplied - dissipated.
struct EnergyBalance {
  double supplied = 0;    ///< J, by torques, errors and stiffness change
  double dissipated = 0;  ///< J, by dampers (>= 0)
  double change = 0;      ///< J, kinetic + elastic
  double relative = 0;    ///< |change - supplied + dissipated| / (dissipated + energy)
};

struct DynamicResponse {
  double mesh_frequency = 0;        ///< Hz
  double mean_mesh_force = 0;       ///< N, T_s / (N r_bs)
  int window_cycles = 0;            ///< evaluated at the end, mesh cycles
  bool whole_error_period = false;  ///< false when `mesh_cycles` or `max_window_cycles` was too short for one
  int total_cycles = 0;             ///< integrated mesh cycles
  bool steady = false;              ///< successive windows agree within steady_tolerance
  /// Largest mesh force difference to the window before / mean mesh force; absent when there was none to compare with.
  std::optional<double> steady_difference;
  MeshKindResult sun_planet, ring_planet;
  EnergyBalance energy;
  /// Momentum balance of the sun's rotation over the window, relative to T_s: mean of sum F_sn r_bs (and of its
  /// torsional support, and the change of angular momentum) against T_s. The mean is taken over the samples: with jumps
  /// of the stiffness it is exact to jumps / samples only.
  double force_balance_relative = 0;
  IntegratorStatistics statistics;
  TimeSeries series;
};

/// Time response of the stage, from its quasi-static state at time 0 to the periodic steady state, and its figures.
/// The error of a figure adds up what the sampling misses, the change from the window before and, with
/// `estimate_error`, the change under a looser integration. An infinite load sharing means instants at which the stage
/// carries no load. Throws InputError when the stage or the options are not usable (no speed, no torque, an unbalanced
/// load: nothing holds the ring), SolverError when the integrator fails.
[[nodiscard]] DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options = {});

}  // namespace annulus::dynamics
