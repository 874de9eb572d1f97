#include "dynamics/steady_state/steady_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/log.h"
#include "dynamics/modes/growth.h"
#include "dynamics/modes/modes.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/steady_state/periodic_solution.h"
#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/steady_state/window_integration.h"

namespace annulus::dynamics {

namespace {

void check_steady(const SteadyProblem& problem, const SimulationOptions& options) {
  if (!std::isfinite(problem.mesh_frequency) || !(problem.mesh_frequency > 0))
    throw InputError(
        fmt::format("a time response needs a mesh frequency above zero, not {} Hz", problem.mesh_frequency));
  if (problem.period_in_cycles < 1)
    throw InputError(fmt::format("a period of {} mesh cycles must be at least 1", problem.period_in_cycles));
  if (!std::isfinite(problem.force_scale) || !(problem.force_scale > 0) || !std::isfinite(problem.stiffness) ||
      !(problem.stiffness > 0))
    throw InputError(fmt::format("a time response needs a positive scale of force (here {} N) and stiffness ({} N/m)",
                                 problem.force_scale, problem.stiffness));
  if (options.samples_per_cycle < 4)
    throw InputError(
        fmt::format("a time series needs at least 4 samples per mesh cycle, not {}", options.samples_per_cycle));
  if (options.mesh_cycles && *options.mesh_cycles < 1)
    throw InputError(fmt::format("a simulation needs at least one mesh cycle, not {}", *options.mesh_cycles));
  if (!(options.steady_tolerance > 0))
    throw InputError(fmt::format("the tolerance {} of the steady state must be positive", options.steady_tolerance));
  if (options.max_windows < 2)
    throw InputError(
        fmt::format("the search for the steady state takes at least two windows, not {}", options.max_windows));
  if (options.min_window_cycles < 1 || options.max_window_cycles < 1)
    throw InputError(fmt::format("the evaluated window must be at least one mesh cycle long, not {} to {}",
                                 options.min_window_cycles, options.max_window_cycles));
}

/// The integrator of the options with an absolute tolerance, tightened; `choice`: where it is chosen here.
IntegratorOptions resolved_integrator(const LumpedSystem& system, const SteadyProblem& problem,
                                      const IntegratorOptions& given, double tightening,
                                      std::optional<IntegratorChoice>& choice) {
  IntegratorOptions integrator = given;
  integrator.relative_tolerance *= tightening;
  if (integrator.absolute_tolerance) *integrator.absolute_tolerance *= tightening;
  if (integrator.method == Integrator::automatic) {
    choice = choose_integrator(system, integrator.relative_tolerance);
    integrator.method = choice->method;
  }
  if (integrator.method == Integrator::runge_kutta_4)
    check_fixed_step(system, problem.mesh_frequency, integrator.fixed_step);
  if (!integrator.absolute_tolerance)
    integrator.absolute_tolerance = 0.1 * integrator.relative_tolerance * problem.force_scale / problem.stiffness;
  return integrator;
}

/// The way to the steady state as a state machine. A step does its work and names the next one:
///
///   solve     -> accept      found, and no confirmation is wanted
///             -> confirm     found
///             -> search      not found, unstable, or not tried because time integration alone is wanted
///             -> integrate   not tried because a length is prescribed or the window holds no whole period
///   accept    -> done
///   confirm   -> evaluate    time integration agrees
///             -> accept      it agrees over a part of a long window
///             -> search      it differs
///   search    -> evaluate
///   integrate -> evaluate
///   evaluate  -> done
///             -> confirm, search, integrate   with tighter tolerances, where energy was lost
class SteadyStateFinder {
 public:
  SteadyStateFinder(const LumpedSystem& system, const SteadyProblem& problem, const SimulationOptions& options)
      : system_(system), problem_(problem), options_(options) {
    const auto [cycles, whole] = window_length(problem.period_in_cycles, options);
    response_.window_cycles = cycles;
    response_.whole_period = whole;
  }

  SteadyResponse run() {
    for (Step step{&SteadyStateFinder::solve}; step.take;) step = (this->*step.take)();
    return std::move(response_);
  }

 private:
  /// The next step; none at the end.
  struct Step {
    Step (SteadyStateFinder::*take)() = nullptr;
  };

  /// Can windows repeat, so that there is a steady state to search for?
  [[nodiscard]] bool searchable() const { return !options_.mesh_cycles && response_.whole_period; }

  [[nodiscard]] bool wants_confirmation() const {
    if (options_.confirmation != Confirmation::where_needed) return options_.confirmation == Confirmation::always;
    return periodic_.loses_contact() || may_miss(system_, *periodic_.report, options_.confirm_beyond);
  }

  /// Periodic solution without time integration.
  Step solve() {
    if (options_.steady_state == SteadyState::harmonic_balance && searchable()) {
      periodic_ = find_periodic_solution(system_, problem_, response_.window_cycles, options_);
      response_.periodic = periodic_.report;
    }
    // Where no multiplier has judged the motion, time integration may end before it departs.
    const bool judged = periodic_.status == PeriodicStatus::found && periodic_.report->largest_multiplier;
    if (!judged && !system_.has_moving_vectors()) refuse_growth(system_, problem_.mesh_frequency);
    if (periodic_.status != PeriodicStatus::found)
      return {searchable() ? &SteadyStateFinder::search : &SteadyStateFinder::integrate_prescribed};
    return {wants_confirmation() ? &SteadyStateFinder::confirm : &SteadyStateFinder::accept};
  }

  /// The periodic solution stands alone.
  Step accept() {
    auto& [fine, compared] = *periodic_.windows;
    response_.steady = true;
    response_.begin = response_.end = {0, fine.displacement.col(0), fine.velocity.col(0)};
    response_.best = std::move(fine);
    response_.before = std::move(compared);
    return {};
  }

  /// Time integration from the periodic solution, over one window. Over two angles, twice around the slower one shows
  /// all that a window shows.
  Step confirm() {
    const int longer = 2 * periodic_.report->longer_angle;
    const bool whole = longer == 0 || longer >= response_.window_cycles;
    auto& windows = start_integration(whole ? response_.window_cycles : longer);
    windows.advance();
    const double difference = largest_difference(windows.last(), periodic_.windows->fine, problem_.force_scale);
    response_.steady_difference = difference;
    response_.steady = response_.confirmed = difference <= options_.steady_tolerance;
    if (whole) return {response_.confirmed ? &SteadyStateFinder::evaluate : &SteadyStateFinder::search};
    integration_.reset();
    return {response_.confirmed ? &SteadyStateFinder::accept : &SteadyStateFinder::search};
  }

  /// Windows until two agree.
  Step search() {
    auto& windows = integration_ ? *integration_ : start_integration(response_.window_cycles);
    // All windows only for a response that stands alone and has, or may have, a periodic solution.
    const bool patient = options_.confirmation == Confirmation::always
                             ? periodic_.status != PeriodicStatus::not_found
                             : options_.confirmation == Confirmation::where_needed && periodic_.windows;
    response_.steady = windows.reach_steady_state(options_, problem_.force_scale,
                                                  patient ? Effort::all_windows : Effort::until_out_of_reach);
    response_.steady_difference = windows.difference_to_before(problem_.force_scale);
    return {&SteadyStateFinder::evaluate};
  }

  /// A prescribed length, or two windows that hold no whole period.
  Step integrate_prescribed() {
    const int cycles = response_.window_cycles;
    auto& windows = start_integration(cycles);
    const int lead = options_.mesh_cycles ? *options_.mesh_cycles - cycles : cycles;
    const bool compared = response_.whole_period && lead >= cycles;
    if (const int skipped = compared ? lead - cycles : lead; skipped > 0) windows.skip(skipped);
    if (compared) windows.advance();
    windows.advance();
    if (compared) response_.steady_difference = windows.difference_to_before(problem_.force_scale);
    if (compared && options_.mesh_cycles) response_.steady = *response_.steady_difference <= options_.steady_tolerance;
    return {&SteadyStateFinder::evaluate};
  }

  /// Energies and errors of the last window.
  Step evaluate() {
    if (const auto lost = integration_->lost_energy(problem_, integrator_)) return tighten(*lost);
    integration_->finish(options_, response_);
    if (response_.confirmed) response_.before = std::move(periodic_.windows->fine);
    // Without loss of contact there is nothing but an unstable motion: slow growth does not show yet.
    if (periodic_.status == PeriodicStatus::unstable && response_.best.open.maxCoeff() == 0) response_.steady = false;
    return {};
  }

  /// The whole integration again with tighter tolerances, as long as that can help.
  Step tighten(double lost) {
    const bool fixed_steps = integrator_.method == Integrator::runge_kutta_4;
    constexpr double tenfold = 0.1, tightest = 1e-10;
    const bool may = options_.tolerance_rule == ToleranceRule::tightened_if_loose && !fixed_steps &&
                     tightening_ * tenfold * options_.integrator.relative_tolerance >= tightest;
    if (!may) {
      const auto message = fmt::format("the time integration lost {:.2g} of the energy: {}", lost, remedy());
      if (fixed_steps || options_.tolerance_rule == ToleranceRule::prescribed) throw InputError(message);
      throw SolverError(message);
    }
    tightening_ *= tenfold;
    log::info(fmt::format(
        "the time integration lost {:.2g} of the energy; it is repeated with a relative tolerance of {:.0e}", lost,
        tightening_ * options_.integrator.relative_tolerance));
    integration_.reset();
    response_.confirmed = false;
    if (periodic_.windows) return {&SteadyStateFinder::confirm};
    return {searchable() ? &SteadyStateFinder::search : &SteadyStateFinder::integrate_prescribed};
  }

  [[nodiscard]] std::string remedy() const {
    if (integrator_.method == Integrator::runge_kutta_4)
      return "its fixed steps are too long (dynamics.steps_per_cycle)";
    if (options_.tolerance_rule == ToleranceRule::prescribed)
      return fmt::format("its relative tolerance of {:.0e} is too loose (dynamics.relative_tolerance)",
                         integrator_.relative_tolerance);
    return fmt::format(
        "tolerances down to {:.0e} did not help; more damping, more load or less backlash make the motion easier to "
        "integrate",
        integrator_.relative_tolerance);
  }

  /// From the periodic solution, else from the start of the problem, else from quasi-static equilibrium.
  WindowIntegration& start_integration(int cycles_per_window) {
    integrator_ = resolved_integrator(system_, problem_, options_.integrator, tightening_, response_.integrator);
    ResponseRun run(system_, problem_.mesh_frequency, options_.samples_per_cycle, integrator_);
    run.sample_forces_closer(closer_samples());
    if (options_.start) {
      const auto &q = options_.start->q, &v = options_.start->v;
      if (q.size() != system_.dofs() || v.size() != system_.dofs())
        throw InputError(
            fmt::format("a start of the time integration needs {} displacements and velocities, not {} and {}",
                        system_.dofs(), q.size(), v.size()));
      run.start_from(q, v);
    }
    if (periodic_.windows)
      run.start_from(periodic_.windows->fine.displacement.col(0), periodic_.windows->fine.velocity.col(0));
    return integration_.emplace(std::move(run), cycles_per_window);
  }

  /// Peaks of vibrations at the highest natural frequency need eight samples per period; long windows have many peaks.
  [[nodiscard]] int closer_samples() const {
    // The implicit method is chosen where vibrations die out at once, and ends a step at every instant.
    if (integrator_.method == Integrator::arkode_implicit) return 1;
    constexpr int most_of_a_cycle = 512, most_of_a_window = 1 << 16;
    const int samples = options_.samples_per_cycle;
    const double highest = modes(system_, mean_stiffnesses(system_)).modes.back().frequency;
    int closer = 1;
    while (closer * samples < 8 * highest / problem_.mesh_frequency && 2 * closer * samples <= most_of_a_cycle &&
           2 * closer * samples * response_.window_cycles <= most_of_a_window)
      closer *= 2;
    return closer;
  }

  const LumpedSystem& system_;
  const SteadyProblem& problem_;
  const SimulationOptions& options_;
  SteadyResponse response_;
  PeriodicSearch periodic_;
  std::optional<WindowIntegration> integration_;
  IntegratorOptions integrator_;  ///< of the integration
  double tightening_ = 1;         ///< factor of its tolerances
};

}  // namespace

void look_for_other_motions(const LumpedSystem& system, const SteadyProblem& problem, const SimulationOptions& options,
                            SteadyResponse& response) {
  if (options.other_motions.starts == 0) return;
  response.motions.reach = reach_of_backlash(system, problem);
  if (response.motions.reach < within_reach) return;
  if (options.mesh_cycles) {
    response.motions.not_tried = "the number of mesh cycles is prescribed";
    return;
  }
  if (problem.period_in_cycles > longest_searched_period) {
    response.motions.not_tried = fmt::format("the excitation repeats after {} mesh cycles; up to {} are searched",
                                             problem.period_in_cycles, longest_searched_period);
    return;
  }
  std::optional<IntegratorChoice> choice;
  auto integrator = resolved_integrator(system, problem, options.integrator, 1, choice);
  constexpr double loose = 1e-5;  // motions are compared to 2 %
  if (const double factor = loose / integrator.relative_tolerance; factor > 1) {
    integrator.relative_tolerance = loose;
    *integrator.absolute_tolerance *= factor;
  }
  auto search = options.other_motions;
  search.starts = affordable_starts(system, problem, integrator, search.starts, stiffness_course(system));
  if (search.starts == 0) {
    response.motions.not_tried = fmt::format("its period of {} mesh cycles takes too long to follow {} starts",
                                             problem.period_in_cycles, options.other_motions.starts);
    return;
  }
  auto [found, states] = stable_motions(system, problem, response, integrator, search);
  found.reach = response.motions.reach;
  found.wanted = options.other_motions.starts;
  const auto largest_force = [&](const ResponseWindow& window) {
    double largest = 0;
    for (Eigen::Index m = 0; m < window.force.rows(); ++m)
      if (system.is_gear_mesh(static_cast<int>(m)))
        largest = std::max(largest, window.force.row(m).cwiseAbs().maxCoeff());
    return largest;
  };
  const auto taken =
      std::find_if(found.list.begin(), found.list.end(), [](const FoundMotion& motion) { return motion.taken; });
  const double present = taken != found.list.end() ? taken->largest_force : largest_force(response.best);
  for (std::size_t i = 0; i < found.list.size(); ++i) {
    auto& motion = found.list[i];
    constexpr double more = 1.02, part = 0.9;
    if (motion.largest_force <= more * present) break;
    auto other = problem;
    other.period_in_cycles *= std::max(1, motion.period);
    const auto in_time = followed_from(options, &states[i]);
    try {
      auto largest = SteadyStateFinder(system, other, in_time).run();
      // Close to a fold the integration may leave it.
      const bool stays = largest_force(largest.best) > part * motion.largest_force;
      if (!stays || (motion.period > 0 && !largest.steady)) continue;
      for (auto& m : found.list) m.taken = false;
      motion.taken = true;
      response = std::move(largest);
      break;
    } catch (const SolverError& error) {
      log::warn(fmt::format("a motion with forces of {:.3g} N could not be followed: {}", motion.largest_force,
                            error.what()));
    }
  }
  response.motions = std::move(found);
}

SimulationOptions followed_from(SimulationOptions options, const SystemState* start) {
  options.steady_state = SteadyState::time_integration;
  options.other_motions.starts = 0;
  options.start.reset();
  if (start) options.start = *start;
  return options;
}

WindowLength window_length(int period, const SimulationOptions& options) {
  const int limit = std::min(options.max_window_cycles, options.mesh_cycles.value_or(options.max_window_cycles));
  if (period > limit) return {limit, false};
  const int wanted = period * ((options.min_window_cycles + period - 1) / period);
  return {wanted <= limit ? wanted : limit / period * period, true};
}

TimeSeries series_of(const LumpedSystem& system, ResponseWindow window) {
  TimeSeries series;
  series.dofs = system.names();
  for (const auto& mesh : system.meshes()) series.meshes.push_back(mesh.name);
  series.time = std::move(window.time);
  series.displacement = std::move(window.displacement);
  series.velocity = std::move(window.velocity);
  series.force = std::move(window.force);
  return series;
}

int enough_samples(int window_cycles) { return window_cycles > long_window ? 16 : 32; }

bool may_miss(const LumpedSystem& system, const PeriodicSolution& found, double beyond) {
  return found.method != PeriodicMethod::piecewise &&
         (found.sampling_difference > beyond || std::isfinite(system.next_jump(0)));
}

SteadyResponse steady_response(const LumpedSystem& system, const SteadyProblem& problem,
                               const SimulationOptions& options) {
  check_steady(problem, options);
  auto response = SteadyStateFinder(system, problem, options).run();
  look_for_other_motions(system, problem, options, response);
  return response;
}

}  // namespace annulus::dynamics
