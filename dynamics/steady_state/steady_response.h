#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/steady_state/periodic_response.h"
#include "dynamics/steady_state/response_run.h"
#include "dynamics/time_integration/integrate.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

/// How the periodic steady state is looked for.
enum class SteadyState {
  /// Exactly where stiffnesses are constant between jumps and no mesh separates, otherwise by harmonic balance;
  /// marching over one window confirms it, or goes on where it does not.
  direct,
  marching,  ///< by time integration from quasi-static equilibrium until windows repeat
};

struct SimulationOptions {
  SteadyState steady_state = SteadyState::direct;
  /// `direct` only. false: where the harmonic balance converges, its solution is taken without any time integration
  /// (sweeps, Monte Carlo); the errors then compare with half the samples, and there is no energy balance.
  bool confirm = true;
  /// Without `confirm`: confirmed nevertheless where a mesh loses contact, beside which other motions may exist.
  bool confirm_where_teeth_part = false;
  bool keep_series = true;   ///< false: figures only
  PeriodicOptions periodic;  ///< samples_per_cycle and motion are set from what stands here
  IntegratorOptions integrator;
  /// Where marching of a stage begins at time 0 (see SteadyProblem::start); a direct solution begins with its own
  /// state.
  std::optional<SystemState> start{};
  /// Total mesh cycles from the start, by marching alone. Absent: until the response repeats, then one error period.
  std::optional<int> mesh_cycles{};
  /// The response counts as periodic when no mesh force differs by more than this, relative to the mean mesh force,
  /// from the harmonic balance; or from one evaluated window earlier, and the differences, continued geometrically, add
  /// up to no more.
  double steady_tolerance = 1e-3;
  /// Marching gives up after so many windows; without `confirm`, or where the harmonic balance found no motion either,
  /// as soon as they come closer so slowly (chaos: not at all) that so many will not do. `steady` is then false.
  int max_windows = 40;
  /// Of the time series and the harmonic balance (a multiple of 8 there, which takes more for itself where marching
  /// would not confirm so few); the highest excited frequency needs at least four samples.
  int samples_per_cycle = 64;
  /// The window is the error period, or as many error periods as reach this many mesh cycles: differences between
  /// short windows say little about slow transients.
  int min_window_cycles = 20;
  /// Upper limit of the window (memory): sun, planet and housing errors together repeat after lcm(z_s, z_p, z_r) mesh
  /// cycles, which may be tens of thousands. A window cut by it cannot be compared with the one before.
  int max_window_cycles = 2000;
  /// Integrates the last window again with a tolerance ten times looser to estimate the integrator's part of the error.
  bool estimate_error = true;

  /// Windows of a loose integration repeat no better than to some of its steps' errors: `steady_tolerance` is made ten
  /// times this where it was less.
  void integrate_within(double relative_tolerance) {
    integrator.relative_tolerance = relative_tolerance;
    steady_tolerance = std::max(steady_tolerance, 10 * relative_tolerance);
  }
};

struct WindowLength {
  int cycles = 0;
  bool whole = false;  ///< whole periods
};
/// The evaluated window of a motion that repeats after `period` mesh cycles.
[[nodiscard]] WindowLength window_length(int period, const SimulationOptions& options);

/// Time series over the evaluated window, equidistant, the end point not included.
struct TimeSeries {
  std::vector<std::string> dofs;    ///< sun_x, planet1_u, ... (all are lengths, m)
  std::vector<std::string> meshes;  ///< sun_planet1 ... ring_planetN
  Eigen::VectorXd time;             ///< s
  Eigen::MatrixXd displacement;     ///< m, one row per DOF, one column per time; rigid rotation included
  Eigen::MatrixXd velocity;         ///< m/s
  Eigen::MatrixXd force;            ///< N, one row per mesh; positive pushes the teeth apart
};
[[nodiscard]] TimeSeries series_of(const LumpedSystem& system, ResponseWindow window);

/// Energy bookkeeping over the window: change of energy = supplied - dissipated.
struct EnergyBalance {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  ///< nothing was integrated
  double supplied = unknown;    ///< J, by torques, errors and stiffness change
  double dissipated = unknown;  ///< J, by dampers (>= 0)
  double change = unknown;      ///< J, kinetic + elastic
  double relative = unknown;    ///< |change - supplied + dissipated| / (dissipated + energy + what is resolved of it)
};

enum class DirectMethod {
  harmonic_balance,
  piecewise,  ///< exact, of systems whose stiffness is constant between jumps, while no mesh separates
};

/// How the direct solution fared.
struct DirectSolution {
  DirectMethod method = DirectMethod::harmonic_balance;
  bool converged = false;
  std::string trouble;  ///< why not
  double residual = 0;  ///< see PeriodicOptions::tolerance
  int newton_iterations = 0, linear_iterations = 0;
  double sampling_difference =
      0;  ///< largest force difference to half the samples / mean mesh force; at least the residual
  /// Piecewise solution alone: largest Floquet multiplier over its period.
  std::optional<double> largest_multiplier{};
};

/// What a steady state is asked of, beside the system itself.
struct SteadyProblem {
  double mesh_frequency = 0;           ///< Hz, > 0: of the cycles in which windows, samples and the period are counted
  int period_in_cycles = 1;            ///< after so many cycles excitation, errors and mesh vectors repeat
  double force_scale = 0;              ///< N, > 0: the mean mesh force, or what stands for it without a torque
  double stiffness = 0;                ///< N/m, > 0: force_scale / stiffness is the deflection integrators resolve
  std::optional<SystemState> start{};  ///< where marching begins at time 0; absent: in quasi-static equilibrium
};

/// How the steady state was found, and how well it is known.
struct SteadyOutcome {
  int window_cycles = 0;      ///< evaluated at the end
  bool whole_period = false;  ///< false when `mesh_cycles` or `max_window_cycles` was too short for one period
  int total_cycles = 0;       ///< integrated cycles; 0: none, the direct solution alone
  bool steady = false;        ///< within steady_tolerance (see there), or taken from the direct solution alone
  bool confirmed = false;     ///< direct solution and time integration agree
  /// Largest mesh force difference to the direct solution (when `confirmed`) or to the window before / force scale (the
  /// mean mesh force); absent when there was none to compare with.
  std::optional<double> steady_difference;
  std::optional<DirectSolution> direct;        ///< absent when only marching was asked for or possible
  std::optional<IntegratorChoice> integrator;  ///< present when it was left to the program and something was integrated
  EnergyBalance energy;
  IntegratorStatistics statistics;
  /// Of the evaluated window where it was integrated; otherwise both the state at its first sample.
  SystemState begin, end;
};

/// The steady state of a system, and the windows that tell how well it is known.
struct SteadyResponse : SteadyOutcome {
  [[nodiscard]] const SteadyOutcome& outcome() const { return *this; }

  ResponseWindow best;
  /// What `best` should equal: the harmonic balance, with half the samples where nothing was integrated (forces alone),
  /// or the window before. Absent when there is none to compare with.
  std::optional<ResponseWindow> before;
  std::optional<ResponseWindow> loose;  ///< `best` under a ten times looser integration
};

/// Periodic steady state of any system: solved for directly (exactly or by harmonic balance, see SteadyState) and
/// confirmed by marching over one window from there; where they disagree, none is found (mesh vectors that move in time
/// refuse it; with jumps of the stiffness, parting teeth and parametric resonance do) or the period is longer than
/// `max_window_cycles`, by marching alone. The torque may have either sign or be zero. `keep_series` has
/// no meaning here: all windows are returned. Throws InputError when problem or options are not usable or the load is
/// not balanced, SolverError when the integrator fails.
[[nodiscard]] SteadyResponse steady_response(const LumpedSystem& system, const SteadyProblem& problem,
                                             const SimulationOptions& options = {});

/// Mesh cycles from which on a window counts as long: its samples stand near every peak even when they are few.
inline constexpr int long_window = 200;
/// Samples per mesh cycle that figures need where many responses are compared (their peaks are refined).
[[nodiscard]] int enough_samples(int window_cycles);

}  // namespace annulus::dynamics
