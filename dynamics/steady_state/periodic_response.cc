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

void fill(PeriodicResponse& response, HarmonicBalance& balance, const Eigen::MatrixXd& approach) {
  const Eigen::Index samples = balance.samples(), meshes = approach.cols();
  Eigen::MatrixXd force;
  std::vector<LumpedSystem::Contact> contact;
  balance.meshes().evaluate_at_instants(approach, balance.rate_of(approach), force, contact);
  response.coarse_force = std::move(response.force);
  response.force = force.transpose();
  response.time.resize(samples);
  for (Eigen::Index i = 0; i < samples; ++i) response.time[i] = balance.meshes().time(i);
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

/// One iteration at the sampling of `finer`, with constant stiffness: harmonics beyond those of the solution come out
/// with their own resonance.
void look_ahead(HarmonicBalance& finer, const Eigen::MatrixXd& approach, PeriodicResponse& response) {
  const Eigen::Index step = finer.samples() / approach.rows();
  const Eigen::MatrixXd refined = HarmonicBalance::refined(approach, step);
  Eigen::MatrixXd residual(refined.rows(), refined.cols()), change(refined.rows(), refined.cols());
  finer.residual(refined, residual);
  finer.meshes().apply_tangent(-residual, Eigen::VectorXd::Zero(refined.cols()), change);
  response.finer_difference = change.cwiseAbs().maxCoeff();
  response.finer_force = response.force + change(Eigen::seq(0, Eigen::last, step), Eigen::all).transpose();
}

bool wants_more_samples(const PeriodicResponse& response, const PeriodicOptions& options) {
  return response.converged && options.sampling_tolerance &&
         response.largest_difference() > *options.sampling_tolerance &&
         2 * response.samples_per_cycle <= options.max_samples_per_cycle;
}

}  // namespace

PeriodicResponse periodic_response(const LumpedSystem& system, double period, int cycles,
                                   const PeriodicOptions& options) {
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
  if (!system.has_fixed_directions()) {
    PeriodicResponse refused;
    refused.trouble = system.has_friction()
                          ? "friction on the flanks needs time integration"
                          : "mesh vectors that move with the mesh (elastic modes of the ring) need time integration";
    return refused;
  }

  const Eigen::Index samples = static_cast<Eigen::Index>(cycles) * options.samples_per_cycle;
  // The first level has few samples, where iterations cost little. Each next one doubles them and starts close to its
  // solution.
  constexpr double rough_tolerance = 1e-3, out_of_reach = 0.1;
  Eigen::Index coarsening = 2;
  while (options.samples_per_cycle % (2 * coarsening) == 0 && options.samples_per_cycle / (2 * coarsening) >= 8)
    coarsening *= 2;
  const Reference reference = reference_of(system);
  Eigen::MatrixXd approach, rate, force;
  SampledMeshes at_reference(system, period, samples / coarsening);
  at_reference.at_deflection(reference.deflection, approach, rate);
  at_reference.evaluate(approach, rate, force);
  const Eigen::VectorXd mean = mean_tangents(system, at_reference.tangent());

  const FrequencyResponse linear(system, mean);
  const double spacing = 2 * std::numbers::pi / period;
  for (const auto& load : system.harmonic_loads())
    if (!load_line(load, spacing, samples / coarsening)) {
      PeriodicResponse refused;
      refused.trouble = fmt::format("a load that repeats after {:g} s does not fit a period of {:g} s with {} samples",
                                    2 * std::numbers::pi / std::abs(load.rate), period, samples / coarsening);
      return refused;
    }
  auto problem = balance_problem(system, linear, mean, period, samples);

  PeriodicResponse response;
  approach.resize(0, 0);
  bool failed = false;
  for (Eigen::Index level = samples / coarsening; level <= samples; level *= 2) {
    HarmonicBalance balance(problem, period, level);
    if (approach.size() == 0) {
      balance.meshes().at_deflection(reference.deflection, approach, rate);
      balance.meshes().evaluate(approach, rate, force);
      approach = balance.linear_solution(approach, rate, force);
    } else {
      approach = HarmonicBalance::refined(approach, 2);
    }
    auto level_options = options;
    // Levels below the two finest only provide a start.
    if (4 * level <= samples) level_options.tolerance = std::max(options.tolerance, rough_tolerance);
    // Where a coarse sampling fails, a finer one would fail or cost too much: the last iterate is returned as it is.
    if (failed) level_options.max_iterations = 0;
    approach = solve_balance(balance, approach, reference.scale, level_options, response);
    if (level == samples / coarsening && !response.converged) {
      if (const auto start = quasi_static(system, balance)) {
        const auto before = std::exchange(response, {});
        auto again = solve_balance(balance, *start, reference.scale, level_options, response);
        response.newton_iterations += before.newton_iterations;
        response.linear_iterations += before.linear_iterations;
        if (response.residual < before.residual)
          approach = std::move(again);
        else
          response = before;
      }
    }
    failed = failed || response.residual > std::max(level_options.tolerance, level < samples ? out_of_reach : 0.0);
    if (2 * level >= samples) fill(response, balance, approach);
    if (level == samples) balance.motion(response.displacement, response.velocity);
  }
  set_coarse_difference(response, options.samples_per_cycle);
  if (!response.converged || !options.sampling_tolerance) return response;
  const int ahead = samples_ahead(linear, cycles / period, options);
  const Eigen::Index finest = static_cast<Eigen::Index>(cycles) * ahead;
  const auto resolve = [&](Eigen::Index level) {
    if (problem.transfer.cols() < 2 * mean.size() * (level / 2 - 1))
      problem.transfer = linear.mesh_transfer(spacing, level / 2 - 1);
  };
  const auto look = [&](PeriodicResponse& found) {
    found.finer_force.resize(0, 0);
    found.finer_difference = 0;
    if (approach.rows() >= finest) return;
    resolve(finest);
    HarmonicBalance finer(problem, period, finest);
    look_ahead(finer, approach, found);
  };
  look(response);
  while (wants_more_samples(response, options)) {
    const Eigen::Index level = 2 * response.time.size();
    resolve(level);
    HarmonicBalance balance(problem, period, level);
    approach = HarmonicBalance::refined(approach, 2);
    auto finer = response;
    approach = solve_balance(balance, approach, reference.scale, options, finer);
    if (!finer.converged) break;
    fill(finer, balance, approach);
    balance.motion(finer.displacement, finer.velocity);
    set_coarse_difference(finer, 2 * response.samples_per_cycle);
    look(finer);
    response = std::move(finer);
  }
  return response;
}

}  // namespace annulus::dynamics
