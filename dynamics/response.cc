#include "dynamics/response.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "dynamics/response_evaluation.h"
#include "dynamics/response_run.h"

namespace annulus::dynamics {

namespace {

void check_simulation(const PlanetaryStage& stage, const SimulationOptions& options) {
  stage.check();
  if (!(stage.carrier_speed > 0)) throw InputError("a time response needs a speed above zero");
  if (!(stage.sun_torque > 0)) throw InputError("a time response needs a positive sun torque (drive flanks loaded)");
  if (options.samples_per_cycle < 4) throw InputError("a time series needs at least 4 samples per mesh cycle");
  if (options.mesh_cycles && *options.mesh_cycles < 1) throw InputError("a simulation needs at least one mesh cycle");
  if (!(options.steady_tolerance > 0)) throw InputError("the tolerance of the steady state must be positive");
  if (options.max_windows < 2) throw InputError("finding the steady state takes at least two windows");
  if (options.min_window_cycles < 1 || options.max_window_cycles < 1)
    throw InputError("the evaluated window must be at least one mesh cycle long");
}

struct WindowLength {
  int cycles = 0;
  bool whole = false;  ///< whole error periods
};

WindowLength window_length(const PlanetaryStage& stage, const SimulationOptions& options) {
  const int period = stage.error_period();
  const int limit = std::min(options.max_window_cycles, options.mesh_cycles.value_or(options.max_window_cycles));
  if (period > limit) return {limit, false};
  const int wanted = period * ((options.min_window_cycles + period - 1) / period);
  return {wanted <= limit ? wanted : limit / period * period, true};
}

double largest_difference(const ResponseWindow& a, const ResponseWindow& b, double mean_force) {
  return (a.force - b.force).cwiseAbs().maxCoeff() / mean_force;
}

/// Integrates until successive windows agree; leaves the last one in `window`.
bool reach_steady_state(ResponseRun& run, int cycles, const SimulationOptions& options, double mean_force,
                        ResponseWindow& window) {
  ResponseWindow before;
  double previous = 0;
  run.advance(cycles, &window);
  for (int i = 1; i < options.max_windows; ++i) {
    std::swap(before, window);
    run.advance(cycles, &window);
    const double difference = largest_difference(window, before, mean_force);
    // What a geometric decay at the observed ratio still has ahead; the first difference knows no ratio and has to be
    // clearly smaller by itself.
    const double ratio = i > 1 ? difference / previous : 0.9;
    if (difference <= options.steady_tolerance &&
        (ratio < 1 ? difference * ratio / (1 - ratio) <= options.steady_tolerance
                   // No decay left to see: the differences are the integrator's own.
                   : difference <= 0.5 * options.steady_tolerance))
      return true;
    previous = difference;
  }
  return false;
}

TimeSeries series_of(const LumpedSystem& system, ResponseWindow window) {
  TimeSeries series;
  series.freedoms = system.names();
  for (const auto& mesh : system.meshes()) series.meshes.push_back(mesh.name);
  series.time = std::move(window.time);
  series.displacement = std::move(window.displacement);
  series.velocity = std::move(window.velocity);
  series.force = std::move(window.force);
  return series;
}

/// The solution of the harmonic balance as a window from time 0, and its forces at half the samples.
struct DirectWindows {
  ResponseWindow fine, coarse;
};

/// Absent when the harmonic balance did not converge; `response.direct` says so.
std::optional<DirectWindows> solve_directly(const LumpedSystem& system, int cycles, const SimulationOptions& options,
                                            DynamicResponse& response) {
  PeriodicOptions periodic_options = options.periodic;
  periodic_options.samples_per_cycle = options.samples_per_cycle;
  periodic_options.motion = true;
  auto periodic = periodic_response(system, cycles / response.mesh_frequency, cycles, periodic_options);
  response.direct = DirectSolution{
      periodic.converged, periodic.trouble, periodic.residual, periodic.newton_iterations, periodic.linear_iterations,
      // Where the balance with half the samples already holds at the finer ones, no
      // step is taken and only the residual is known of what is left.
      std::max(periodic.sampling_difference / response.mean_mesh_force, periodic.residual)};
  if (!periodic.converged) return std::nullopt;
  DirectWindows windows;
  windows.fine = {options.samples_per_cycle,        std::move(periodic.time),     std::move(periodic.force),
                  std::move(periodic.displacement), std::move(periodic.velocity), std::move(periodic.open)};
  windows.coarse.samples_per_cycle = options.samples_per_cycle / 2;
  windows.coarse.force = std::move(periodic.coarse_force);
  return windows;
}

void set_figures(const PlanetaryStage& stage, const SimulationOptions& options, const ResponseEvidence& evidence,
                 DynamicResponse& response) {
  int positions = options.samples_per_cycle;
  if (response.window_cycles > long_window) positions = std::min(positions, enough_samples(response.window_cycles));
  const QuasiStatic path = quasi_static(stage, positions, options.max_window_cycles);
  const Eigen::Index n = stage.planets();
  response.sun_planet = evaluate_meshes(evidence, 0, n, path.sun_force);
  response.ring_planet = evaluate_meshes(evidence, n, n, path.ring_force);
}

void set_energy(const SystemState& end, double before, double after, EnergyBalance& energy) {
  energy.supplied = end.supplied;
  energy.dissipated = end.dissipated;
  energy.change = after - before;
  energy.relative = std::abs(energy.change - end.supplied + end.dissipated) /
                    (end.dissipated + std::max(std::abs(before), std::abs(after)));
}

/// The last window of a march, its energies booked, and the same window with a looser integration.
struct LastWindow {
  ResponseWindow window, loose;
  SystemState begin;
};

LastWindow march_last_window(ResponseRun& run, int cycles, const SimulationOptions& options, EnergyBalance& energy) {
  LastWindow last;
  last.begin = run.state();
  run.pass_jump();
  const double before = run.energy();
  ResponseRun loose_run = run;
  run.advance(cycles, &last.window, true);
  set_energy(run.state(), before, run.energy(), energy);
  if (options.estimate_error) {
    loose_run.loosen(10);
    loose_run.advance(cycles, &last.loose);
  }
  return last;
}

}  // namespace

int enough_samples(int window_cycles) { return window_cycles > long_window ? 16 : 32; }

DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options) {
  check_simulation(stage, options);
  const auto [cycles, whole] = window_length(stage, options);
  DynamicResponse response;
  response.mesh_frequency = stage.mesh_frequency();
  response.mean_mesh_force = stage.mean_mesh_force();
  response.window_cycles = cycles;
  response.whole_error_period = whole;
  const double mean_force = response.mean_mesh_force;
  const LumpedSystem system = assemble(stage);

  std::optional<DirectWindows> direct;
  if (options.steady_state == SteadyState::direct && !options.mesh_cycles && whole)
    direct = solve_directly(system, cycles, options, response);
  if (direct && !options.confirm) {
    response.steady = true;
    const SystemState anywhere{0, direct->fine.displacement.col(0), direct->fine.velocity.col(0)};
    response.force_balance_relative = force_balance(stage, system, direct->fine, anywhere, anywhere, cycles);
    set_figures(stage, options, {direct->fine, direct->coarse, direct->fine, mean_force}, response);
    if (options.keep_series) response.series = series_of(system, std::move(direct->fine));
    return response;
  }

  IntegratorOptions integrator = options.integrator;
  if (integrator.method == Integrator::automatic) {
    response.integrator = choose_integrator(system, integrator.relative_tolerance);
    integrator.method = response.integrator->method;
  }
  ResponseRun run(stage, system, options, integrator);
  ResponseWindow before;
  LastWindow last;
  bool compared = false;
  if (direct) {
    run.start_from(direct->fine.displacement.col(0), direct->fine.velocity.col(0));
    last = march_last_window(run, cycles, options, response.energy);
    response.steady_difference = largest_difference(last.window, direct->fine, mean_force);
    response.steady = response.confirmed = *response.steady_difference <= options.steady_tolerance;
    if (response.confirmed) {
      compared = true;
      before = std::move(direct->fine);
    }
  }
  if (!response.confirmed) {
    if (!options.mesh_cycles && whole) {
      response.steady = reach_steady_state(run, cycles, options, mean_force, before);
      compared = true;
    } else {
      // A given length, or windows that do not repeat: no search for the steady state.
      const int lead = options.mesh_cycles ? *options.mesh_cycles - cycles : cycles;
      if (lead > cycles) run.advance(lead - cycles, nullptr);
      if (lead >= cycles) run.advance(cycles, &before);
      if (lead > 0 && lead < cycles) run.advance(lead, nullptr);
      compared = whole && lead >= cycles;
    }
    last = march_last_window(run, cycles, options, response.energy);
    if (compared) {
      response.steady_difference = largest_difference(last.window, before, mean_force);
      if (options.mesh_cycles) response.steady = *response.steady_difference <= options.steady_tolerance;
    }
  }

  response.total_cycles = run.cycles();
  response.statistics = run.statistics();
  response.force_balance_relative = force_balance(stage, system, last.window, last.begin, run.state(), cycles);
  set_figures(
      stage, options,
      {last.window, compared ? before : last.window, options.estimate_error ? last.loose : last.window, mean_force},
      response);
  if (options.keep_series) response.series = series_of(system, std::move(last.window));
  return response;
}

}  // namespace annulus::dynamics
