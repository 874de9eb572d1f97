#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/not_known.h"
#include "dynamics/steady_state/other_motions.h"
#include "dynamics/steady_state/periodic_response.h"
#include "dynamics/steady_state/response_run.h"
#include "dynamics/system/drive_line.h"
#include "dynamics/time_integration/integrate.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

/// Method that finds the periodic steady state.
enum class SteadyState {
  /// Harmonic balance, or the exact piecewise solution where stiffnesses are constant between jumps and no mesh loses
  /// contact. Time integration over one window confirms the solution, or goes on where it does not.
  harmonic_balance,
  time_integration,  ///< from quasi-static equilibrium until windows repeat
};

/// Which harmonic balances a time integration confirms. One that stands alone states its difference to other samplings
/// as its error, and has no energy balance.
enum class Confirmation {
  never,
  /// Where a mesh loses contact, because other motions may then exist, where more samples still change forces by more
  /// than `confirm_beyond`, and where the stiffness jumps.
  where_needed,
  always
};

/// Samples of the harmonic balance.
enum class Sampling {
  prescribed,  ///< `samples_per_cycle`
  as_needed  ///< doubled until that and a look at more samples change forces by no more than 1 to 3 `steady_tolerance`
};

/// What happens where the time integration loses energy.
enum class ToleranceRule {
  prescribed,         ///< it ends
  tightened_if_loose  ///< it is repeated with a tighter relative tolerance
};

struct SimulationOptions {
  SteadyState steady_state = SteadyState::harmonic_balance;
  Confirmation confirmation = Confirmation::always;
  Sampling sampling = Sampling::as_needed;
  /// `where_needed` confirms where other samplings of the harmonic balance change a force by more than this, relative
  /// to the force scale.
  double confirm_beyond = 0.01;
  ToleranceRule tolerance_rule = ToleranceRule::prescribed;
  bool keep_series = true;   ///< false: results without time series
  PeriodicOptions periodic;  ///< `samples_per_cycle` is overwritten by that of this struct
  IntegratorOptions integrator;
  /// Start of the time integration at time 0; absent: quasi-static equilibrium. From a harmonic balance the integration
  /// starts with the state of its solution.
  std::optional<SystemState> start{};
  /// Total mesh cycles from the start, by time integration alone. Absent: until the response repeats, then one error
  /// period.
  std::optional<int> mesh_cycles{};
  /// The response counts as periodic when no mesh force differs by more than this, relative to the mean mesh force,
  /// from the harmonic balance or from the evaluated window before. In the second case the differences, continued
  /// geometrically, must not add up to more either.
  double steady_tolerance = 1e-3;
  /// Most windows of the time integration. With `Confirmation::never`, or where no periodic solution was found, it ends
  /// as soon as the decay of the differences shows that so many windows will not do. `steady` is then false.
  int max_windows = 40;
  /// Samples per mesh cycle of the time series and, at least, of the harmonic balance (a multiple of 8 there). The
  /// highest excited frequency needs four samples.
  int samples_per_cycle = 64;
  /// The window is one error period, or as many error periods as reach this many mesh cycles. Differences between short
  /// windows show little of slow transients.
  int min_window_cycles = 20;
  /// Upper limit of the window (memory). Error periods may be tens of thousands of mesh
  /// cycles (see the error_period of a system). A window cut by this limit cannot be compared with the one before.
  int max_window_cycles = 2000;
  /// Integrates the last window again with a tolerance ten times looser, fixed steps with half of them: an estimate of
  /// the error of the integrator.
  bool estimate_error = true;
  MotionSearch other_motions;  ///< looked for where reach_of_backlash() exceeds `within_reach`

  /// Sets the tolerance of the integrator. Windows of a loose integration repeat to some of its step errors only, so
  /// `steady_tolerance` is raised to at least ten times this value.
  void integrate_within(double relative_tolerance) {
    integrator.relative_tolerance = relative_tolerance;
    steady_tolerance = std::max(steady_tolerance, 10 * relative_tolerance);
  }
  /// Integrates over a prescribed length, of which the last `evaluated` mesh cycles are the window, for comparisons.
  void integrate_for(int lead, int evaluated) {
    mesh_cycles = lead + evaluated;
    max_window_cycles = evaluated;
    estimate_error = false;
    keep_series = false;
    other_motions.starts = 0;
  }
};

/// Time integration alone, from a state at time 0 (null: from equilibrium), and no look for other motions.
[[nodiscard]] SimulationOptions followed_from(SimulationOptions options, const SystemState* start);

struct WindowLength {
  int cycles = 0;
  bool whole = false;  ///< whole periods
};
/// The evaluated window of a motion that repeats after `period` mesh cycles.
[[nodiscard]] WindowLength window_length(int period, const SimulationOptions& options);

/// Time series over the evaluated window, equidistant, without the end point.
struct TimeSeries {
  std::vector<std::string> dofs;    ///< names; all are lengths, m
  std::vector<std::string> meshes;  ///< names of the meshes
  Eigen::VectorXd time;             ///< s
  Eigen::MatrixXd displacement;     ///< m, DOFs x times; rigid rotation included
  Eigen::MatrixXd velocity;         ///< m/s, DOFs x times
  Eigen::MatrixXd force;            ///< N, meshes x times; positive where the flanks press on each other
};
[[nodiscard]] TimeSeries series_of(const LumpedSystem& system, ResponseWindow window);

/// Energies over the window: change of energy = supplied - dissipated. NaN where nothing was integrated in time.
struct EnergyBalance {
  double supplied = not_known;    ///< J, by torques, errors and stiffness change
  double dissipated = not_known;  ///< J, by dampers (>= 0)
  double change = not_known;      ///< J, kinetic + elastic
  double relative = not_known;    ///< |change - supplied + dissipated| / (dissipated + energy + its resolution)
};

/// Data of the steady state beside the system itself.
struct SteadyProblem {
  double mesh_frequency = 0;  ///< Hz, > 0: of the cycles in which windows, samples and the period are counted
  int period_in_cycles = 1;   ///< mesh cycles after which excitation, errors and mesh vectors repeat
  double force_scale = 0;     ///< N, > 0: the mean mesh force, or a substitute without a torque
  double stiffness = 0;       ///< N/m, > 0: force_scale / stiffness is the deflection that integrators resolve
};

/// A system with the data of its steady state.
struct LumpedCase {
  LumpedSystem system;
  SteadyProblem problem;
  Turning turning{};
};

/// How the steady state was found, and how well it is known.
struct SteadyOutcome {
  int window_cycles = 0;      ///< mesh cycles of the evaluated window
  bool whole_period = false;  ///< false when `mesh_cycles` or `max_window_cycles` is shorter than one period
  int total_cycles = 0;       ///< mesh cycles integrated in time; 0: the periodic solution alone
  bool steady = false;        ///< within `steady_tolerance`, or taken from the periodic solution alone
  bool confirmed = false;     ///< periodic solution and time integration agree
  /// Largest mesh force difference to the periodic solution (when `confirmed`) or to the window before, relative to the
  /// force scale. Absent when there was nothing to compare with.
  std::optional<double> steady_difference;
  std::optional<PeriodicSolution> periodic;    ///< absent when time integration alone was asked for or possible
  std::optional<IntegratorChoice> integrator;  ///< present when chosen automatically
  EnergyBalance energy;
  IntegratorStatistics statistics;
  FoundMotions motions;  ///< where several were found this is the one with the largest force
  /// States at the ends of the evaluated window where it was integrated; otherwise both the state at its first sample.
  SystemState begin, end;
};

/// The steady state of a system, with the windows that show how well it is known.
struct SteadyResponse : SteadyOutcome {
  ResponseWindow best;
  /// Window that `best` should equal: the periodic solution where it was confirmed, the forces at another sampling
  /// where the harmonic balance stands alone (see PeriodicWindows::compared), or the window before. Absent when there
  /// is none.
  std::optional<ResponseWindow> before;
  std::optional<ResponseWindow> loose;  ///< `best` under a looser integration, or one of half the fixed steps
};

/// Periodic steady state of any system. A periodic solution (see SteadyState) is confirmed by time integration over one
/// window. Time integration goes on alone where the two disagree, where no solution is found, or where the period is
/// longer than `max_window_cycles`. Where `other_motions` finds a motion with larger forces, time integration from it
/// gives the response.
///
/// No periodic solution exists where mesh vectors move in time; with jumps of the stiffness, loss of contact and
/// parametric resonance prevent it too. The torque may have either sign or be zero. `keep_series` has no effect: all
/// windows are returned.
///
/// Throws InputError when problem or options are not usable, the load is not balanced, or small motions grow
/// (refuse_growth), SolverError when the integrator fails.
[[nodiscard]] SteadyResponse steady_response(const LumpedSystem& system, const SteadyProblem& problem,
                                             const SimulationOptions& options = {});

/// What steady_response does at its end, for a response that was found without: looks for other motions of the system,
/// and replaces the response by the one with the largest force.
void look_for_other_motions(const LumpedSystem& system, const SteadyProblem& problem, const SimulationOptions& options,
                            SteadyResponse& response);

/// Whether a harmonic balance that stands alone may miss more of a force than `beyond` (relative to the force scale):
/// other samplings change it by more, or the stiffness jumps, and forces peak at jumps, between the samples.
[[nodiscard]] bool may_miss(const LumpedSystem& system, const PeriodicSolution& found, double beyond);

/// Mesh cycles from which on a window counts as long: few samples per cycle then already stand near every peak.
inline constexpr int long_window = 200;
/// Samples per mesh cycle for comparisons of many responses, whose peaks are refined.
[[nodiscard]] int enough_samples(int window_cycles);

}  // namespace annulus::dynamics
