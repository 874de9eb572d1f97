#include "dynamics/steady_state/steady_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "dynamics/steady_state/floquet.h"
#include "dynamics/steady_state/piecewise_response.h"

namespace annulus::dynamics {

namespace {

void check(const SteadyProblem& problem, const SimulationOptions& options) {
  if (!std::isfinite(problem.mesh_frequency) || !(problem.mesh_frequency > 0))
    throw InputError("a time response needs a speed above zero");
  if (problem.period_in_cycles < 1)
    throw InputError(fmt::format("a period of {} mesh cycles is none", problem.period_in_cycles));
  if (!std::isfinite(problem.force_scale) || !(problem.force_scale > 0) || !std::isfinite(problem.stiffness) ||
      !(problem.stiffness > 0))
    throw InputError("a time response needs a positive scale of force and stiffness to measure differences against");
  if (options.samples_per_cycle < 4) throw InputError("a time series needs at least 4 samples per mesh cycle");
  if (options.mesh_cycles && *options.mesh_cycles < 1) throw InputError("a simulation needs at least one mesh cycle");
  if (!(options.steady_tolerance > 0)) throw InputError("the tolerance of the steady state must be positive");
  if (options.max_windows < 2) throw InputError("finding the steady state takes at least two windows");
  if (options.min_window_cycles < 1 || options.max_window_cycles < 1)
    throw InputError("the evaluated window must be at least one mesh cycle long");
}

double largest_difference(const ResponseWindow& a, const ResponseWindow& b, double mean_force) {
  return (a.force - b.force).cwiseAbs().maxCoeff() / mean_force;
}

/// Windows over which a decay shows.
constexpr int stretch = 8;

/// Is the tolerance out of reach in `left` more windows at the pace at which the largest differences of eight windows
/// went down from the eight before? (Chaos: they do not.)
bool hopeless(const std::vector<double>& differences, int left, double tolerance) {
  if (static_cast<std::ptrdiff_t>(differences.size()) < 2 * stretch) return false;
  const auto end = differences.end();
  const double now = *std::max_element(end - stretch, end), then = *std::max_element(end - 2 * stretch, end - stretch);
  return now * std::pow(std::min(now / then, 1.0), static_cast<double>(left) / stretch) > tolerance;
}

/// A run marched window by window, of which the last two are kept.
class March {
 public:
  March(ResponseRun run, int cycles_per_window) : run_(std::move(run)), cycles_(cycles_per_window) {}

  /// On its way without a window.
  void pass(int cycles) { run_.advance(cycles, nullptr); }
  void advance() {
    std::swap(before_, last_);
    begin_ = run_.state();
    run_.pass_jump();
    at_begin_.emplace(run_);
    run_.advance(cycles_, &last_, true);
    ++windows_;
  }
  [[nodiscard]] int windows() const { return windows_; }
  [[nodiscard]] const ResponseWindow& last() const { return last_; }
  [[nodiscard]] double difference_to_before(double force_scale) const {
    return largest_difference(last_, before_, force_scale);
  }
  /// The last window and what belongs to it; the run is at its end then.
  void finish(const SteadyProblem& problem, const SimulationOptions& options, SteadyResponse& response);

 private:
  ResponseRun run_;
  std::optional<ResponseRun> at_begin_;  ///< of the last window
  SystemState begin_;
  ResponseWindow before_, last_;
  int cycles_ = 0, windows_ = 0;
};

/// Marches on until successive windows agree. `patient`: as far as `max_windows` even where that will not do.
bool reach_steady_state(March& march, const SimulationOptions& options, double mean_force, bool patient) {
  double previous = 0;
  std::vector<double> differences;
  bool agreed = false;
  if (march.windows() == 0) march.advance();
  for (int i = 1; i < options.max_windows; ++i) {
    march.advance();
    const double difference = march.difference_to_before(mean_force);
    // What a geometric decay at the observed ratio still has ahead; the first difference knows no ratio and has to be
    // clearly smaller by itself.
    const double ratio = i > 1 ? difference / previous : 0.9;
    const bool agrees = difference <= options.steady_tolerance &&
                        (ratio < 1 ? difference * ratio / (1 - ratio) <= options.steady_tolerance
                                   // No decay left to see: the differences are the integrator's own.
                                   : difference <= 0.5 * options.steady_tolerance);
    // A chaotic motion comes by an unstable periodic one now and then, and leaves it again: once differences have gone
    // on for so long, one that is small tells nothing.
    if (agrees && (i < stretch || agreed)) return true;
    agreed = agrees;
    previous = difference;
    differences.push_back(difference);
    if (!patient && hopeless(differences, options.max_windows - i, options.steady_tolerance)) return false;
  }
  return false;
}

/// The direct solution as a window from time 0, and the forces of the harmonic balance at half the samples.
struct DirectWindows {
  ResponseWindow fine;
  std::optional<ResponseWindow> coarse;
};

/// The samples right after the jumps of a window from time 0.
std::vector<Eigen::Index> samples_after_jumps(const LumpedSystem& system, double duration, Eigen::Index samples) {
  std::vector<Eigen::Index> list;
  const double spacing = duration / static_cast<double>(samples);
  for (double t = system.next_jump(0); t < duration; t = system.next_jump(t)) {
    const auto sample = static_cast<Eigen::Index>(std::ceil(t / spacing - 1e-9));
    if (sample < samples && (list.empty() || list.back() != sample)) list.push_back(sample);
  }
  return list;
}

/// The jumps of the exact solution, which spans one period of the excitation, over the whole window.
void set_jumps(const PiecewiseResponse& exact, double duration, int cycles, ResponseWindow& window) {
  const Eigen::Index jumps = exact.jump_time.size(), periods = cycles / exact.solved_cycles;
  window.jump_time.resize(periods * jumps);
  for (Eigen::Index i = 0; i < periods; ++i)
    window.jump_time.segment(i * jumps, jumps) =
        exact.jump_time.array() + static_cast<double>(i) * duration / static_cast<double>(periods);
  window.force_before = exact.force_before.replicate(1, periods);
  window.force_after = exact.force_after.replicate(1, periods);
}

/// Absent when teeth part or the motion is unstable; `direct` says so.
std::optional<DirectWindows> solve_exactly(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                                           const SimulationOptions& options, std::optional<DirectSolution>& direct) {
  const double duration = cycles / problem.mesh_frequency;
  auto exact = piecewise_response(system, duration, cycles, {options.samples_per_cycle, true});
  auto& periodic = exact.periodic;
  direct = DirectSolution{.method = DirectMethod::piecewise,
                          .converged = periodic.converged,
                          .trouble = periodic.trouble,
                          .residual = periodic.residual,
                          .sampling_difference = periodic.residual,
                          .largest_multiplier = exact.largest_multiplier};
  if (!periodic.converged) return std::nullopt;
  DirectWindows windows;
  windows.fine = {options.samples_per_cycle,        std::move(periodic.time),     std::move(periodic.force),
                  std::move(periodic.displacement), std::move(periodic.velocity), std::move(periodic.open)};
  windows.fine.dense_force = std::move(exact.dense_force);
  windows.fine.dense_after_jump = std::move(exact.dense_after_jump);
  windows.fine.after_jump = samples_after_jumps(system, duration, windows.fine.time.size());
  if (!std::isfinite(system.next_jump(0))) return windows;
  set_jumps(exact, duration, cycles, windows.fine);
  return windows;
}

/// Of a harmonic balance: more where the period is short.
int most_samples_per_cycle(int period) {
  constexpr int most = 512, most_of_a_period = 1 << 13;
  return std::min(most, most_of_a_period / period);
}

/// Absent when the harmonic balance did not converge; `direct` says so.
std::optional<DirectWindows> solve_directly(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                                            const SimulationOptions& options, std::optional<DirectSolution>& direct) {
  // Constant stiffness belongs to the harmonic balance as well, which also follows parting teeth there; jumps it meets
  // to second order only.
  if (std::isfinite(system.next_jump(0)) && why_not_piecewise(system, cycles / problem.mesh_frequency).empty())
    return solve_exactly(system, problem, cycles, options, direct);
  const int period = problem.period_in_cycles;
  PeriodicOptions periodic_options = options.periodic;
  periodic_options.samples_per_cycle = options.samples_per_cycle;
  periodic_options.motion = true;
  if (options.confirm) {
    // The error of a sampling is about a third of what halving it changes.
    periodic_options.sampling_tolerance = 3 * options.steady_tolerance * problem.force_scale;
    periodic_options.max_samples_per_cycle = most_samples_per_cycle(period);
  }
  auto periodic = periodic_response(system, period / problem.mesh_frequency, period, periodic_options);
  direct = DirectSolution{
      .converged = periodic.converged,
      .trouble = periodic.trouble,
      .residual = periodic.residual,
      .newton_iterations = periodic.newton_iterations,
      .linear_iterations = periodic.linear_iterations,
      // Where the balance with half the samples already holds at the finer ones, no
      // step is taken and only the residual is known of what is left.
      .sampling_difference = std::max(periodic.sampling_difference / problem.force_scale, periodic.residual)};
  if (!periodic.converged) return std::nullopt;
  // Of the samples that it took those that were asked for, over all periods of the window.
  const Eigen::Index step = periodic.samples_per_cycle / options.samples_per_cycle;
  const auto in_window = [&](const Eigen::MatrixXd& values) -> Eigen::MatrixXd {
    return values(Eigen::all, Eigen::seq(0, Eigen::last, step)).replicate(1, cycles / period);
  };
  DirectWindows windows;
  const Eigen::Index samples = static_cast<Eigen::Index>(cycles) * options.samples_per_cycle;
  windows.fine.samples_per_cycle = options.samples_per_cycle;
  windows.fine.time = Eigen::VectorXd::LinSpaced(samples + 1, 0, cycles / problem.mesh_frequency).head(samples);
  windows.fine.force = in_window(periodic.force);
  windows.fine.displacement = in_window(periodic.displacement);
  windows.fine.velocity = in_window(periodic.velocity);
  windows.fine.open = std::move(periodic.open);
  windows.coarse.emplace();
  windows.coarse->samples_per_cycle = options.samples_per_cycle / 2;
  windows.coarse->force = in_window(periodic.coarse_force);
  return windows;
}

/// Would the motion stay on the solution of a harmonic balance? From an unstable one it departs too slowly for one
/// window to tell.
bool stays(const LumpedSystem& system, const SteadyProblem& problem, const DirectWindows& found,
           std::optional<DirectSolution>& direct) {
  const bool parting = found.fine.open.size() > 0 && found.fine.open.maxCoeff() > 0;
  // A thousandfold growth over a thousand cycles would pass unseen; double zero eigenvalues are 1e-7 from 1.
  constexpr double still = 1e-4;
  if (parting || direct->method != DirectMethod::harmonic_balance || system.has_moving_vectors()) return true;
  direct->largest_multiplier = growth_per_cycle(system, problem.mesh_frequency, found.fine);
  if (*direct->largest_multiplier <= 1 + still) return true;
  direct->converged = false;
  direct->trouble =
      fmt::format("parametric resonance: disturbances of the periodic motion grow {:.4g} times per mesh cycle",
                  *direct->largest_multiplier);
  return false;
}

/// What a run has booked before `begin`, in a window that did not confirm, is none of this one's.
void set_energy(const SystemState& begin, const SystemState& end, double before, double after, double resolved,
                EnergyBalance& energy) {
  energy.supplied = end.supplied - begin.supplied;
  energy.dissipated = end.dissipated - begin.dissipated;
  energy.change = after - before;
  energy.relative = std::abs(energy.change - energy.supplied + energy.dissipated) /
                    (energy.dissipated + std::max(std::abs(before), std::abs(after)) + resolved);
}

/// Energies below this are not known: displacements are to a thousandth from a hundred times their tolerance on, and to
/// rounding, which matters where backlash is far wider than deflections.
double resolved_energy(const LumpedSystem& system, const Eigen::VectorXd& displacement, const SteadyProblem& problem,
                       double relative_tolerance) {
  const double resolved = 100 * relative_tolerance * problem.force_scale;
  const Eigen::VectorXd distance = displacement.cwiseAbs();
  const double rounding = 1e-15 * distance.dot(system.stiffness().cwiseAbs() * distance);
  return resolved * resolved / (2 * problem.stiffness) + rounding;
}

/// The energies of the last window are booked, and it is marched once more with a looser integration.
void March::finish(const SteadyProblem& problem, const SimulationOptions& options, SteadyResponse& response) {
  require(at_begin_.has_value(), "a march ends with a window");
  response.begin = begin_;
  response.end = run_.state();
  const double resolved =
      resolved_energy(run_.system(), response.end.q, problem, options.integrator.relative_tolerance);
  set_energy(response.begin, response.end, at_begin_->energy(), run_.energy(), resolved, response.energy);
  // Adaptive steps keep it near their tolerance whatever happens; fixed ones may be far too long for what does.
  constexpr double hopeless = 0.05;
  if (!(response.energy.relative <= hopeless))
    throw SolverError(fmt::format("the time integration lost {:.2g} of the energy: {}", response.energy.relative,
                                  options.integrator.method == Integrator::runge_kutta_4
                                      ? "its fixed steps are too long (dynamics.steps_per_cycle)"
                                      : "its tolerance is too loose (dynamics.relative_tolerance)"));
  if (options.estimate_error) {
    at_begin_->loosen(10);
    response.loose.emplace();
    at_begin_->advance(cycles_, &*response.loose);
  }
  response.best = std::move(last_);
  if (windows_ > 1) response.before = std::move(before_);
  response.total_cycles = run_.cycles();
  response.statistics = run_.statistics();
}

}  // namespace

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

SteadyResponse steady_response(const LumpedSystem& system, const SteadyProblem& problem,
                               const SimulationOptions& options) {
  check(problem, options);
  const auto [cycles, whole] = window_length(problem.period_in_cycles, options);
  SteadyResponse response;
  response.window_cycles = cycles;
  response.whole_period = whole;

  std::optional<DirectWindows> direct;
  if (options.steady_state == SteadyState::direct && !options.mesh_cycles && whole)
    direct = solve_directly(system, problem, cycles, options, response.direct);
  const bool unstable = direct && options.confirm && !stays(system, problem, *direct, response.direct);
  if (unstable) direct.reset();
  const bool parting = direct && direct->fine.open.size() > 0 && direct->fine.open.maxCoeff() > 0;
  if (direct && !options.confirm && !(options.confirm_where_teeth_part && parting)) {
    response.steady = true;
    response.begin = response.end = {0, direct->fine.displacement.col(0), direct->fine.velocity.col(0)};
    response.best = std::move(direct->fine);
    response.before = std::move(direct->coarse);
    return response;
  }

  IntegratorOptions integrator = options.integrator;
  if (integrator.method == Integrator::automatic) {
    response.integrator = choose_integrator(system, integrator.relative_tolerance);
    integrator.method = response.integrator->method;
  }
  if (integrator.method == Integrator::runge_kutta_4)
    check_fixed_step(system, problem.mesh_frequency, integrator.fixed_step);
  if (!integrator.absolute_tolerance)
    integrator.absolute_tolerance = 0.1 * integrator.relative_tolerance * problem.force_scale / problem.stiffness;
  ResponseRun run(system, problem.mesh_frequency, options.samples_per_cycle, integrator);
  if (problem.start) {
    if (problem.start->q.size() != system.dofs() || problem.start->v.size() != system.dofs())
      throw InputError(
          fmt::format("a start of the time integration needs {} displacements and velocities", system.dofs()));
    run.start_from(problem.start->q, problem.start->v);
  }
  if (direct) run.start_from(direct->fine.displacement.col(0), direct->fine.velocity.col(0));
  March march(std::move(run), cycles);
  if (direct) {
    march.advance();
    response.steady_difference = largest_difference(march.last(), direct->fine, problem.force_scale);
    response.steady = response.confirmed = *response.steady_difference <= options.steady_tolerance;
  }
  if (!response.confirmed) {
    if (!options.mesh_cycles && whole) {
      // One response among many is not worth every effort, nor is one of which the harmonic balance found none either.
      const bool patient = options.confirm && (!response.direct || direct || unstable);
      response.steady = reach_steady_state(march, options, problem.force_scale, patient);
      response.steady_difference = march.difference_to_before(problem.force_scale);
    } else {
      // A given length, or windows that do not repeat: no search for the steady state.
      const int lead = options.mesh_cycles ? *options.mesh_cycles - cycles : cycles;
      const bool compared = whole && lead >= cycles;
      if (const int passed = compared ? lead - cycles : lead; passed > 0) march.pass(passed);
      if (compared) march.advance();
      march.advance();
      if (compared) response.steady_difference = march.difference_to_before(problem.force_scale);
      if (compared && options.mesh_cycles) response.steady = *response.steady_difference <= options.steady_tolerance;
    }
  }
  march.finish(problem, options, response);
  if (response.confirmed) response.before = std::move(direct->fine);
  // As long as no teeth part, nothing but an unstable motion is there: what grows slowly has not grown yet.
  if (unstable && response.best.open.maxCoeff() == 0) response.steady = false;
  return response;
}

}  // namespace annulus::dynamics
