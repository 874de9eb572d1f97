#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/figures.h"
#include "dynamics/integrate.h"
#include "dynamics/integrator_choice.h"
#include "dynamics/periodic_response.h"
#include "dynamics/planetary_stage.h"

namespace annulus::dynamics {

/// How the periodic steady state is looked for.
enum class SteadyState {
  direct,    ///< by harmonic balance; marching over one window confirms it, or goes on where it does not
  marching,  ///< by time integration from quasi-static equilibrium until windows repeat
};

struct SimulationOptions {
  SteadyState steady_state = SteadyState::direct;
  /// `direct` only. false: where the harmonic balance converges, its solution is taken without any time integration
  /// (sweeps, Monte Carlo); the errors then compare with half the samples, and there is no energy balance.
  bool confirm = true;
  bool keep_series = true;   ///< false: figures only
  PeriodicOptions periodic;  ///< samples_per_cycle and motion are set from what stands here
  IntegratorOptions integrator;
  /// Total mesh cycles from the start, by marching alone. Absent: until the response repeats, then one error period.
  std::optional<int> mesh_cycles;
  /// The response counts as periodic when no mesh force differs by more than this, relative to the mean mesh force,
  /// from the harmonic balance; or from one evaluated window earlier, and the differences, continued geometrically, add
  /// up to no more.
  double steady_tolerance = 1e-3;
  int max_windows = 40;  ///< gives up after so many windows (chaos, nearly undamped): `steady` is then false
  /// Of the time series and the harmonic balance (a multiple of 8 there); the highest excited frequency needs at least
  /// four samples.
  int samples_per_cycle = 64;
  /// The window is the error period, or as many error periods as reach this many mesh cycles: differences between
  /// short windows say little about slow transients.
  int min_window_cycles = 20;
  /// Upper limit of the window (memory): sun, planet and housing errors together repeat after lcm(z_s, z_p, z_r) mesh
  /// cycles, which may be tens of thousands. A window cut by it cannot be compared with the one before.
  int max_window_cycles = 2000;
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
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  ///< nothing was integrated
  double supplied = unknown;    ///< J, by torques, errors and stiffness change
  double dissipated = unknown;  ///< J, by dampers (>= 0)
  double change = unknown;      ///< J, kinetic + elastic
  double relative = unknown;    ///< |change - supplied + dissipated| / (dissipated + energy)
};

/// How the harmonic balance fared.
struct DirectSolution {
  bool converged = false;
  std::string trouble;  ///< why not
  double residual = 0;  ///< see PeriodicOptions::tolerance
  int newton_iterations = 0, linear_iterations = 0;
  double sampling_difference =
      0;  ///< largest force difference to half the samples / mean mesh force; at least the residual
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
  EnergyBalance energy;
  /// Momentum balance of the sun's rotation over the window, relative to T_s: mean of sum F_sn r_bs (and of its
  /// torsional support, and the change of angular momentum) against T_s. The mean is taken over the samples: with jumps
  /// of the stiffness it is exact to jumps / samples only.
  double force_balance_relative = 0;
  IntegratorStatistics statistics;
  TimeSeries series;
};

/// Mesh cycles from which on a window counts as long: its samples stand near every peak even when they are few.
inline constexpr int long_window = 200;
/// Samples per mesh cycle that figures need where many responses are compared (their peaks are refined).
[[nodiscard]] int enough_samples(int window_cycles);

/// Periodic steady state of the stage and its figures: solved for directly and confirmed by marching over one window
/// from there (two independent methods); where they disagree, no balance is found or the error period is longer than
/// `max_window_cycles`, by marching alone. The error of a figure adds up what the sampling misses, the change from the
/// harmonic balance or the window before and, with `estimate_error`, the change under a looser integration. An infinite
/// load sharing means instants at which the stage carries no load. Throws InputError when the stage or the options are
/// not usable (no speed, no torque, an unbalanced load: nothing holds the ring), SolverError when the integrator fails.
[[nodiscard]] DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options = {});

}  // namespace annulus::dynamics
