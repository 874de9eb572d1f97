#include "dynamics/steady_state/periodic_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/harmonic_balance.h"
#include "dynamics/steady_state/newton_krylov.h"
#include "dynamics/steady_state/second_angle.h"

namespace annulus::dynamics {

namespace {

/// Solves the harmonic balance from these approaches, with residuals relative to `scale` (m). Adds to the iterations of
/// the response and sets residual, converged and trouble.
Eigen::MatrixXd solve_balance(HarmonicBalance& balance, const Eigen::MatrixXd& start, double scale,
                              const PeriodicOptions& options, PeriodicResponse& response) {
  const Eigen::Index rows = start.rows(), columns = start.cols();
  Eigen::MatrixXd result(rows, columns);
  const Equations equations{[&](const Eigen::VectorXd& u, Eigen::VectorXd& residual) {
                              balance.residual(u.reshaped(rows, columns), result);
                              residual = result.reshaped();
                            },
                            [&](const Eigen::VectorXd& v, Eigen::VectorXd& product) {
                              balance.apply_derivative(v.reshaped(rows, columns), result);
                              product = result.reshaped();
                            }};
  const auto solved = solve_newton_krylov(
      equations, start.reshaped(),
      {.tolerance = options.tolerance, .weight = 1 / scale, .max_iterations = options.max_iterations});
  response.newton_iterations += solved.newton_iterations;
  response.linear_iterations += solved.linear_iterations;
  response.residual = solved.residual;
  response.converged = solved.converged;
  if (!response.converged && response.trouble.empty())
    response.trouble = fmt::format("residual {:.1e} after {} iterations with {} samples: {}", response.residual,
                                   solved.newton_iterations, rows, solved.trouble);
  return solved.u.reshaped(rows, columns);
}

/// Deflections under load at time 0; a mesh without contact is at the edge of its backlash.
struct Reference {
  Eigen::VectorXd deflection;
  double scale = 0;  ///< m, largest deformation of a mesh
};

Reference reference_of(const LumpedSystem& system) {
  StaticSolver solver(system);
  auto workspace = system.workspace();
  if (std::isfinite(system.next_jump(0))) system.hold_waves(0.5 * system.next_jump(0), workspace);
  (void)solver.solve(0, workspace);
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  Reference reference{Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), meshes), 0};
  for (int m = 0; m < meshes; ++m)
    if (system.is_gear_mesh(m))
      reference.scale = std::max(reference.scale, std::abs(workspace.force[m]) / workspace.stiffness[m]);
  if (!(reference.scale > 0)) reference.scale = std::max(reference.deflection.cwiseAbs().maxCoeff(), 1e-9);
  return reference;
}

/// Mean over time of dF/d delta at the reference; where the teeth are apart there, of the stiffness.
Eigen::VectorXd mean_tangents(const LumpedSystem& system, const Eigen::MatrixXd& tangent) {
  Eigen::VectorXd mean = tangent.colwise().mean();
  for (Eigen::Index m = 0; m < mean.size(); ++m)
    if (!(mean[m] > 0)) mean[m] = mean_stiffness(system.meshes()[m].excitation);
  return mean;
}

/// Approaches in the equilibria at all sampled times; nothing where one is not found.
std::optional<Eigen::MatrixXd> quasi_static(const LumpedSystem& system, HarmonicBalance& balance) {
  Eigen::VectorXd times(balance.samples());
  for (Eigen::Index i = 0; i < times.size(); ++i) times[i] = balance.meshes().time(i);
  try {
    return (system.mesh_vectors().transpose() * static_path(system, times).displacement).transpose();
  } catch (const SolverError&) {
    return std::nullopt;
  }
}

/// Forces over a window of `count` samples, and the shares of flanks that press.
void fill(PeriodicResponse& response, HarmonicBalance& balance, const Eigen::MatrixXd& approach, Eigen::Index count) {
  const Eigen::Index samples = approach.rows(), meshes = approach.cols();
  Eigen::MatrixXd force;
  std::vector<LumpedSystem::Contact> contact;
  balance.at_instants(approach, balance.rate_of(approach), force, contact);
  response.coarse_force = std::move(response.force);
  response.force = balance.along(force, count).transpose();
  response.time.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) response.time[i] = balance.meshes().time(i);
  const auto share = [&](Eigen::Index m, LumpedSystem::Contact state) {
    return static_cast<double>(std::count(contact.begin() + m * samples, contact.begin() + (m + 1) * samples, state)) /
           static_cast<double>(samples);
  };
  response.open.resize(meshes);
  response.back.resize(meshes);
  for (Eigen::Index m = 0; m < meshes; ++m) {
    response.open[m] = share(m, LumpedSystem::Contact::open);
    response.back[m] = share(m, LumpedSystem::Contact::back);
  }
}

void set_coarse_difference(PeriodicResponse& response, int samples_per_cycle) {
  response.samples_per_cycle = samples_per_cycle;
  response.coarse_difference = 0;
  for (Eigen::Index i = 0; i < response.coarse_force.cols(); ++i)
    response.coarse_difference = std::max(
        response.coarse_difference, (response.force.col(2 * i) - response.coarse_force.col(i)).cwiseAbs().maxCoeff());
}

/// Samples per mesh cycle to look ahead to: four per period of the highest natural frequency.
int samples_ahead(const FrequencyResponse& linear, double mesh_frequency, const PeriodicOptions& options) {
  const double needed = 4 * linear.highest_rate() / (2 * std::numbers::pi * mesh_frequency);
  int ahead = options.samples_per_cycle;
  while (ahead < needed && 2 * ahead <= options.max_samples_ahead) ahead *= 2;
  return ahead;
}

bool wants_more_samples(const PeriodicResponse& response, const PeriodicOptions& options) {
  return response.converged && options.sampling_tolerance &&
         response.largest_difference() > *options.sampling_tolerance &&
         2 * response.samples_per_cycle <= options.max_samples_per_cycle;
}

void check(double period, int cycles, const PeriodicOptions& options, const LumpedSystem& system) {
  if (!(period > 0) || cycles < 1)
    throw InputError(fmt::format("a periodic response needs a positive period of whole cycles, not {} s and {} cycles",
                                 period, cycles));
  if (options.samples_per_cycle < 8 || options.samples_per_cycle % 8 != 0)
    throw InputError(fmt::format("harmonic balance needs a multiple of 8 samples per mesh cycle, not {}",
                                 options.samples_per_cycle));
  if (!(options.tolerance > 0) || options.max_iterations < 1)
    throw InputError(
        fmt::format("harmonic balance needs a positive tolerance and at least one iteration, not {} and {}",
                    options.tolerance, options.max_iterations));
  require(!system.meshes().empty(),
          fmt::format("a periodic response needs meshes; the system has {} degrees of freedom alone", system.dofs()));
}

/// A harmonic balance from few samples to many. Matrices of the grid become windows of all mesh cycles.
class Levels {
 public:
  /// `system`: with all errors; `reduced`: without those of the second angle. `first_cycles`: of the first angle.
  Levels(const LumpedSystem& system, const LumpedSystem& reduced, BalanceGrid grid, int first_cycles, double period,
         int cycles, const PeriodicOptions& options)
      : system_(system),
        reduced_(reduced),
        options_(options),
        grid_(std::move(grid)),
        period_(period),
        cycles_(cycles),
        first_cycles_(first_cycles),
        reference_(reference_of(system)) {}

  PeriodicResponse solve() {
    const Eigen::Index samples = samples_of(options_.samples_per_cycle);
    // The first level has few samples, where iterations cost little. Each next one doubles them and starts close to its
    // solution.
    Eigen::Index coarsening = 2;
    while (options_.samples_per_cycle % (2 * coarsening) == 0 && options_.samples_per_cycle / (2 * coarsening) >= 8)
      coarsening *= 2;
    SampledMeshes at_reference(reduced_, grid_.period, samples / coarsening);
    at_reference.at_deflection(reference_.deflection, approach_, rate_);
    at_reference.evaluate(approach_, rate_, force_);
    mean_ = mean_tangents(reduced_, at_reference.tangent());
    linear_.emplace(reduced_, mean_);
    for (const auto& load : system_.harmonic_loads())
      if (!load_line(load, grid_.spacing(), samples / coarsening)) {
        response_.trouble =
            fmt::format("a load that repeats after {:g} s does not fit a period of {:g} s with {} samples",
                        2 * std::numbers::pi / std::abs(load.rate), grid_.period, samples / coarsening);
        return std::move(response_);
      }
    problem_.emplace(balance_problem(reduced_, *linear_, mean_, grid_, samples));
    first_level(samples / coarsening, samples);
    if (!grid_.waves.empty()) settle_rows(samples / coarsening);
    for (Eigen::Index level = samples / coarsening; level <= samples; level *= 2) next_level(level, samples);
    set_coarse_difference(response_, options_.samples_per_cycle);
    response_.coarse_difference = std::max(response_.coarse_difference, rows_difference_);
    if (response_.converged && options_.sampling_tolerance) refine();
    fill_motion();
    return std::move(response_);
  }

 private:
  static constexpr double rough_tolerance = 1e-3, out_of_reach = 0.1;

  [[nodiscard]] Eigen::Index samples_of(int per_cycle) const {
    return static_cast<Eigen::Index>(first_cycles_) * per_cycle;
  }
  /// Over the whole window.
  [[nodiscard]] Eigen::Index in_window(Eigen::Index samples) const { return samples / first_cycles_ * cycles_; }

  PeriodicOptions options_at(Eigen::Index level, Eigen::Index samples) const {
    auto options = options_;
    // Levels below the two finest only provide a start.
    if (4 * level <= samples) options.tolerance = std::max(options.tolerance, rough_tolerance);
    // Where a coarse sampling fails, a finer one would fail or cost too much: the last iterate is returned as it is.
    if (failed_) options.max_iterations = 0;
    return options;
  }

  void first_level(Eigen::Index level, Eigen::Index samples) {
    HarmonicBalance balance(*problem_, level);
    balance.at_deflection(reference_.deflection, approach_, rate_);
    balance.forces(approach_, rate_, force_);
    approach_ = balance.linear_solution(approach_, rate_, force_);
    const auto options = options_at(level, samples);
    approach_ = solve_balance(balance, approach_, reference_.scale, options, response_);
    if (!response_.converged && grid_.waves.empty()) {
      if (const auto start = quasi_static(system_, balance)) {
        const auto before = std::exchange(response_, {});
        auto again = solve_balance(balance, *start, reference_.scale, options, response_);
        response_.newton_iterations += before.newton_iterations;
        response_.linear_iterations += before.linear_iterations;
        if (response_.residual < before.residual)
          approach_ = std::move(again);
        else
          response_ = before;
      }
    }
    solved_ = level;
    failed_ = response_.residual > std::max(options.tolerance, level < samples ? out_of_reach : 0.0);
  }

  /// Values of the second angle until more of them change nothing. Fails where so many are not worth it.
  void settle_rows(Eigen::Index level) {
    Eigen::MatrixXd before;
    const double enough = options_.sampling_tolerance.value_or(0) > 0
                              ? *options_.sampling_tolerance / 10
                              : rough_tolerance * reference_.scale * mean_.maxCoeff();
    for (;;) {
      HarmonicBalance balance(*problem_, level);
      balance.forces(approach_, balance.rate_of(approach_), force_);
      const Eigen::MatrixXd force = balance.along(force_, in_window(level));
      if (before.size() > 0) rows_difference_ = (force - before).cwiseAbs().maxCoeff();
      if (failed_ || (before.size() > 0 && rows_difference_ <= enough)) return;
      before = force;
      const int rows = 2 * grid_.rows - 1;
      if (2 * rows * first_cycles_ > cycles_) {
        response_.converged = false;
        response_.trouble = fmt::format(
            "{} values of the second angle change forces by {:.2g} N, and more take as long as a whole period",
            grid_.rows, rows_difference_);
        failed_ = true;
        return;
      }
      approach_ = at_rows(approach_, grid_.rows, rows);
      grid_.rows = rows;
      problem_.emplace(balance_problem(reduced_, *linear_, mean_, grid_, samples_of(options_.samples_per_cycle)));
      HarmonicBalance finer(*problem_, level);
      auto options = options_;
      options.tolerance = std::max(options.tolerance, rough_tolerance / 10);
      approach_ = solve_balance(finer, approach_, reference_.scale, options, response_);
      failed_ = !response_.converged;
    }
  }

  void next_level(Eigen::Index level, Eigen::Index samples) {
    HarmonicBalance balance(*problem_, level);
    if (level != solved_) {
      approach_ = HarmonicBalance::refined(approach_, 2, grid_.rows);
      const auto options = options_at(level, samples);
      approach_ = solve_balance(balance, approach_, reference_.scale, options, response_);
      failed_ = failed_ || response_.residual > std::max(options.tolerance, level < samples ? out_of_reach : 0.0);
    }
    if (2 * level >= samples) fill(response_, balance, approach_, in_window(level));
  }

  void fill_motion() {
    HarmonicBalance balance(*problem_, approach_.rows() / grid_.rows);
    Eigen::MatrixXd residual(approach_.rows(), approach_.cols());
    balance.residual(approach_, residual);
    balance.motion(response_.displacement, response_.velocity);
    if (balance.rows() == 1) return;
    for (auto* motion : {&response_.displacement, &response_.velocity})
      *motion = balance.along(motion->transpose(), in_window(balance.samples())).transpose();
  }

  /// One iteration at more samples, with constant stiffness: harmonics beyond those of the solution come out with their
  /// own resonance.
  void look_ahead(PeriodicResponse& found) {
    found.finer_force.resize(0, 0);
    found.finer_difference = 0;
    const Eigen::Index finest = samples_of(samples_ahead(*linear_, cycles_ / period_, options_));
    const Eigen::Index samples = approach_.rows() / grid_.rows;
    if (samples >= finest) return;
    resolve(*problem_, finest);
    HarmonicBalance finer(*problem_, finest);
    const Eigen::Index step = finest / samples;
    const Eigen::MatrixXd refined = HarmonicBalance::refined(approach_, step, grid_.rows);
    Eigen::MatrixXd residual(refined.rows(), refined.cols());
    finer.residual(refined, residual);
    const Eigen::MatrixXd change = finer.force_change(-residual);
    found.finer_difference = change.cwiseAbs().maxCoeff();
    const HarmonicBalance coarse(*problem_, samples);
    found.finer_force =
        found.force +
        coarse.along(change(Eigen::seq(0, Eigen::last, step), Eigen::all), in_window(samples)).transpose();
  }

  void refine() {
    look_ahead(response_);
    while (wants_more_samples(response_, options_)) {
      const int per_cycle = 2 * response_.samples_per_cycle;
      const Eigen::Index level = samples_of(per_cycle);
      resolve(*problem_, level);
      HarmonicBalance balance(*problem_, level);
      auto finer = response_;
      Eigen::MatrixXd approach = HarmonicBalance::refined(approach_, 2, grid_.rows);
      approach = solve_balance(balance, approach, reference_.scale, options_, finer);
      if (!finer.converged) break;
      approach_ = std::move(approach);
      fill(finer, balance, approach_, in_window(level));
      set_coarse_difference(finer, per_cycle);
      finer.coarse_difference = std::max(finer.coarse_difference, rows_difference_);
      look_ahead(finer);
      response_ = std::move(finer);
    }
  }

  const LumpedSystem &system_, &reduced_;
  const PeriodicOptions& options_;
  BalanceGrid grid_;
  double period_;
  int cycles_, first_cycles_;
  Reference reference_;
  Eigen::MatrixXd approach_, rate_, force_;
  Eigen::VectorXd mean_;
  std::optional<FrequencyResponse> linear_;
  std::optional<BalanceProblem> problem_;
  PeriodicResponse response_;
  Eigen::Index solved_ = 0;
  double rows_difference_ = 0;  // N, of half as many values of the second angle
  bool failed_ = false;
};

}  // namespace

PeriodicResponse periodic_response(const LumpedSystem& system, double period, int cycles,
                                   const PeriodicOptions& options) {
  check(period, cycles, options, system);
  if (!system.has_fixed_directions()) {
    PeriodicResponse refused;
    refused.trouble = system.has_friction()
                          ? "friction on the flanks needs time integration"
                          : "mesh vectors that move with the mesh (elastic modes of the ring) need time integration";
    return refused;
  }
  return Levels(system, system, {.period = period}, cycles, period, cycles, options).solve();
}

PeriodicResponse two_frequency_response(const LumpedSystem& system, const TwoFrequencies& angles, double period,
                                        int cycles, const PeriodicOptions& options) {
  check(period, cycles, options, system);
  const auto reduced = without_waves(system, angles.waves);
  constexpr int rows = 3;
  auto response = Levels(system, reduced,
                         {.period = period / cycles * angles.cycles,
                          .rows = rows,
                          .second_rate = angles.second_rate,
                          .waves = angles.waves},
                         angles.cycles, period, cycles, options)
                      .solve();
  response.method = PeriodicMethod::two_frequencies;
  response.longer_angle =
      std::max(angles.cycles,
               static_cast<int>(std::lround(2 * std::numbers::pi * cycles / period / std::abs(angles.second_rate))));
  return response;
}

}  // namespace annulus::dynamics
