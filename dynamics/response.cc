#include "dynamics/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "dynamics/static_solver.h"

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

/// Samples of one window: meshes (and freedoms) x times.
struct Window {
  Eigen::VectorXd time;
  Eigen::MatrixXd force, displacement, velocity;
  Eigen::VectorXd open;  ///< fraction of the samples without contact, per mesh
};

/// The stage on its way: state and workspace, advanced window by window.
class Run {
 public:
  Run(const PlanetaryStage& stage, const SimulationOptions& options)
      : stage_(stage), options_(options), system_(assemble(stage)), workspace_(system_.workspace()) {
    integrator_ = options.integrator;
    if (!integrator_.absolute_tolerance)
      integrator_.absolute_tolerance =
          0.1 * integrator_.relative_tolerance * stage.mean_mesh_force() / mean_stiffness(stage.sun_mesh);
    start_from_equilibrium();
  }

  void advance(int cycles, Window* window, bool track_energy = false) {
    const double end = (cycles_ + cycles) / stage_.mesh_frequency();
    const int samples = window ? cycles * options_.samples_per_cycle : 0;
    if (window) {
      const auto meshes = static_cast<Eigen::Index>(system_.meshes().size());
      window->time.resize(samples);
      window->force.resize(meshes, samples);
      window->displacement.resize(system_.freedoms(), samples);
      window->velocity.resize(system_.freedoms(), samples);
      window->open = Eigen::VectorXd::Zero(meshes);
    }
    const auto sample = [&](int i, const SystemState& state) {
      window->time[i] = state.time;
      window->displacement.col(i) = state.q;
      window->velocity.col(i) = state.v;
      for (Eigen::Index m = 0; m < window->force.rows(); ++m) {
        window->force(m, i) = workspace_.force[m];
        if (workspace_.contact[m] == LumpedSystem::Contact::open) window->open[m] += 1.0 / samples;
      }
    };
    const auto s = integrate(system_, state_, end, integrator_, workspace_, samples, sample, track_energy);
    cycles_ += cycles;
    statistics_.steps += s.steps;
    statistics_.rhs_evaluations += s.rhs_evaluations;
    statistics_.jacobian_evaluations += s.jacobian_evaluations;
    statistics_.contact_events += s.contact_events;
    statistics_.stiffness_restarts += s.stiffness_restarts;
  }

  /// Energy at the end of what has been integrated, a stiffness jump at this very instant not yet done.
  [[nodiscard]] double energy() {
    Eigen::VectorXd y(2 * system_.freedoms());
    y << state_.q, state_.v;
    return system_.energy(state_.time, y.data(), workspace_);
  }

  /// Does a stiffness jump at this very instant: whole mesh cycles are where waves jump.
  void pass_jump() {
    const double next = system_.next_jump(state_.time);
    if (std::isfinite(next)) system_.hold_waves((state_.time + next) / 2, workspace_);
  }

  void loosen(double factor) {
    // At most a tenth: beyond, the comparison would say little.
    integrator_.relative_tolerance = std::min(0.1, integrator_.relative_tolerance * factor);
    *integrator_.absolute_tolerance *= factor;
    integrator_.fixed_step *= std::pow(factor, 0.25);  // the error of the fixed-step method goes with step^4
  }

  [[nodiscard]] const LumpedSystem& system() const { return system_; }
  [[nodiscard]] const SystemState& state() const { return state_; }
  [[nodiscard]] const IntegratorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] int cycles() const { return cycles_; }

 private:
  /// The quasi-static path at time 0 excites less than a start from rest: its displacement and, where the stiffness
  /// does not jump, its velocity.
  void start_from_equilibrium() {
    StaticSolver solver(system_);
    state_.v = Eigen::VectorXd::Zero(system_.freedoms());
    if (!std::isfinite(system_.next_jump(0))) {
      const double h = 1e-3 / stage_.mesh_frequency();  // a thousandth of a cycle: smooth there, far above rounding
      const Eigen::VectorXd after = solver.solve(h, workspace_), before = solver.solve(-h, workspace_);
      state_.v = (after - before) / (2 * h);
    }
    state_.q = solver.solve(0, workspace_);
  }

  const PlanetaryStage& stage_;
  const SimulationOptions& options_;
  LumpedSystem system_;
  LumpedSystem::Workspace workspace_;
  IntegratorOptions integrator_;
  SystemState state_;
  IntegratorStatistics statistics_;
  int cycles_ = 0;
};

double largest_difference(const Window& a, const Window& b, double mean_force) {
  return (a.force - b.force).cwiseAbs().maxCoeff() / mean_force;
}

/// Integrates until successive windows agree; leaves the last one in `window`.
bool reach_steady_state(Run& run, int cycles, const SimulationOptions& options, double mean_force, Window& window) {
  Window before;
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

/// Largest value of a sampled curve: as sampled, and at the top of the parabola through the highest sample and its
/// neighbours. Their difference tells what the sampling misses.
struct Peak {
  double sampled = 0, refined = 0;
};

Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  Eigen::Index i = 0;
  Peak peak;
  peak.sampled = peak.refined = values.maxCoeff(&i);
  if (i == 0 || i + 1 >= values.size() || !std::isfinite(peak.sampled)) return peak;
  const double rise = values[i] - values[i - 1], fall = values[i] - values[i + 1];
  if (rise + fall > 0) peak.refined += (rise - fall) * (rise - fall) / (8 * (rise + fall));
  return peak;
}

Peak highest(const Peak& a, const Peak& b) { return {std::max(a.sampled, b.sampled), std::max(a.refined, b.refined)}; }

/// Highest peak over the rows of a matrix of branches x times.
Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  Peak peak = peak_of(values.row(0));
  for (Eigen::Index i = 1; i < values.rows(); ++i) peak = highest(peak, peak_of(values.row(i)));
  return peak;
}

Peak sharing_peak(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  const double sampled = load_sharing_instantaneous(force);
  if (!std::isfinite(sampled)) return {sampled, sampled};
  return peak_of_rows(load_sharing_over_time(force));
}

/// The refined peak with the sum of what the sampling misses and of the differences to other runs: these are
/// independent causes that may add up.
Figure figure(const Peak& best, std::initializer_list<Peak> others) {
  Figure result{best.refined, 0};
  if (!std::isfinite(best.refined)) return result;
  result.error = best.refined - best.sampled;
  for (const auto& other : others) result.error += std::abs(best.refined - other.refined);
  return result;
}

Peak averaged_peak(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle) {
  const double value = load_sharing_averaged(force, samples_per_cycle);  // smooth: a sliding mean needs no refinement
  return {value, value};
}

struct Evidence {
  const Window &window, &before, &loose;
  int samples_per_cycle;
  double mean_force;
};

MeshKindResult evaluate(const Evidence& evidence, Eigen::Index first, Eigen::Index planets,
                        const Eigen::MatrixXd& quasi_static_force) {
  const auto rows = [&](const Window& w) { return w.force.middleRows(first, planets); };
  const auto best = rows(evidence.window), before = rows(evidence.before), loose = rows(evidence.loose);
  const int cycle = evidence.samples_per_cycle;
  MeshKindResult result;
  auto& sharing = result.load_sharing;
  sharing.instantaneous = figure(sharing_peak(best), {sharing_peak(before), sharing_peak(loose)});
  sharing.averaged = figure(averaged_peak(best, cycle), {averaged_peak(before, cycle), averaged_peak(loose, cycle)});
  sharing.quasi_static = figure(sharing_peak(quasi_static_force), {});
  for (Eigen::Index p = 0; p < planets; ++p) {
    const double f = evidence.mean_force;
    BranchResult branch;
    branch.dynamic_factor_max =
        figure(peak_of(best.row(p) / f), {peak_of(before.row(p) / f), peak_of(loose.row(p) / f)});
    branch.dynamic_factor_min = evidence.window.force.row(first + p).minCoeff() / f;
    branch.mean_force = evidence.window.force.row(first + p).mean();
    branch.contact_loss = evidence.window.open[first + p];
    result.branches.push_back(branch);
  }
  return result;
}

double force_balance(const PlanetaryStage& stage, const LumpedSystem& system, const Window& window,
                     const SystemState& begin, const SystemState& end) {
  const int u = system.find("sun_u");
  const double duration = end.time - begin.time;
  const double forces = window.force.topRows(stage.planets()).colwise().sum().mean();
  const double support = system.stiffness()(u, u) * window.displacement.row(u).mean() +
                         system.damping()(u, u) * (end.q[u] - begin.q[u]) / duration;
  const double inertia = system.mass()(u, u) * (end.v[u] - begin.v[u]) / duration;
  return std::abs((forces + support + inertia) / system.load()[u] - 1);
}

TimeSeries series_of(const LumpedSystem& system, Window window) {
  TimeSeries series;
  series.freedoms = system.names();
  for (const auto& mesh : system.meshes()) series.meshes.push_back(mesh.name);
  series.time = std::move(window.time);
  series.displacement = std::move(window.displacement);
  series.velocity = std::move(window.velocity);
  series.force = std::move(window.force);
  return series;
}

}  // namespace

DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options) {
  check_simulation(stage, options);
  const auto [cycles, whole] = window_length(stage, options);
  DynamicResponse response;
  response.mesh_frequency = stage.mesh_frequency();
  response.mean_mesh_force = stage.mean_mesh_force();
  response.window_cycles = cycles;
  response.whole_error_period = whole;

  Run run(stage, options);
  Window window, before;
  bool compared = false;
  if (!options.mesh_cycles && whole) {
    response.steady = reach_steady_state(run, cycles, options, response.mean_mesh_force, before);
    compared = true;
  } else {
    // A given length, or windows that do not repeat: no search for the steady state.
    const int lead = options.mesh_cycles ? *options.mesh_cycles - cycles : cycles;
    if (lead > cycles) run.advance(lead - cycles, nullptr);
    if (lead >= cycles) run.advance(cycles, &before);
    if (lead > 0 && lead < cycles) run.advance(lead, nullptr);
    compared = whole && lead >= cycles;
  }

  const SystemState begin = run.state();
  run.pass_jump();
  const double energy_before = run.energy();
  Run loose_run = run;
  run.advance(cycles, &window, true);
  if (compared) {
    response.steady_difference = largest_difference(window, before, response.mean_mesh_force);
    if (options.mesh_cycles) response.steady = *response.steady_difference <= options.steady_tolerance;
  }
  Window loose;
  if (options.estimate_error) {
    loose_run.loosen(10);
    loose_run.advance(cycles, &loose);
  }

  const auto& end = run.state();
  response.total_cycles = run.cycles();
  response.statistics = run.statistics();
  const double energy_after = run.energy();
  response.energy.supplied = end.supplied;
  response.energy.dissipated = end.dissipated;
  response.energy.change = energy_after - energy_before;
  response.energy.relative = std::abs(response.energy.change - end.supplied + end.dissipated) /
                             (end.dissipated + std::max(std::abs(energy_before), std::abs(energy_after)));
  response.force_balance_relative = force_balance(stage, run.system(), window, begin, end);

  const QuasiStatic path = quasi_static(stage, options.samples_per_cycle, options.max_window_cycles);
  const Evidence evidence{window, compared ? before : window, options.estimate_error ? loose : window,
                          options.samples_per_cycle, response.mean_mesh_force};
  const Eigen::Index n = stage.planets();
  response.sun_planet = evaluate(evidence, 0, n, path.sun_force);
  response.ring_planet = evaluate(evidence, n, n, path.ring_force);
  response.series = series_of(run.system(), std::move(window));
  return response;
}

}  // namespace annulus::dynamics
