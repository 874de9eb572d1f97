#include "dynamics/steady_state/periodic_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/steady_state/floquet.h"
#include "dynamics/steady_state/piecewise_response.h"

namespace annulus::dynamics {

namespace {

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
void set_exact_jumps(const PiecewiseResponse& exact, double duration, int cycles, ResponseWindow& window) {
  const Eigen::Index jumps = exact.jump_time.size(), periods = cycles / exact.solved_cycles;
  window.jump_time.resize(periods * jumps);
  for (Eigen::Index i = 0; i < periods; ++i)
    window.jump_time.segment(i * jumps, jumps) =
        exact.jump_time.array() + static_cast<double>(i) * duration / static_cast<double>(periods);
  window.force_before = exact.force_before.replicate(1, periods);
  window.force_after = exact.force_after.replicate(1, periods);
}

/// The exact solution of a system with piecewise constant stiffness.
PeriodicSearch solve_piecewise(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                               const SimulationOptions& options) {
  const double duration = cycles / problem.mesh_frequency;
  auto exact = piecewise_response(system, duration, cycles, {options.samples_per_cycle, true});
  auto& periodic = exact.periodic;
  PeriodicSearch search;
  search.status = periodic.converged ? PeriodicStatus::found : PeriodicStatus::not_found;
  search.report = PeriodicSolution{.method = PeriodicMethod::piecewise,
                                   .converged = periodic.converged,
                                   .trouble = periodic.trouble,
                                   .residual = periodic.residual,
                                   .sampling_difference = periodic.residual,
                                   .largest_multiplier = exact.largest_multiplier};
  if (!periodic.converged) return search;
  auto& fine = search.windows.emplace().fine;
  fine = {options.samples_per_cycle,        std::move(periodic.time),     std::move(periodic.force),
          std::move(periodic.displacement), std::move(periodic.velocity), std::move(periodic.open)};
  fine.dense_force = std::move(exact.dense_force);
  fine.dense_after_jump = std::move(exact.dense_after_jump);
  fine.after_jump = samples_after_jumps(system, duration, fine.time.size());
  if (std::isfinite(system.next_jump(0))) set_exact_jumps(exact, duration, cycles, fine);
  return search;
}

/// Limit of the samples of a harmonic balance: higher where the period is short.
int most_samples_per_cycle(int period) {
  constexpr int most = 512, most_of_a_period = 1 << 13;
  return std::min(most, most_of_a_period / period);
}

PeriodicOptions balance_options(const SteadyProblem& problem, const SimulationOptions& options) {
  PeriodicOptions balance = options.periodic;
  balance.samples_per_cycle = options.samples_per_cycle;
  balance.motion = true;
  if (options.confirm) {
    // The error of a sampling is about a third of the change when the samples are halved.
    balance.sampling_tolerance = 3 * options.steady_tolerance * problem.force_scale;
    balance.max_samples_per_cycle = most_samples_per_cycle(problem.period_in_cycles);
  }
  return balance;
}

PeriodicSearch solve_harmonic_balance(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                                      const SimulationOptions& options) {
  const int period = problem.period_in_cycles;
  auto periodic = periodic_response(system, period / problem.mesh_frequency, period, balance_options(problem, options));
  PeriodicSearch search;
  search.status = periodic.converged ? PeriodicStatus::found : PeriodicStatus::not_found;
  search.report = PeriodicSolution{
      .converged = periodic.converged,
      .trouble = periodic.trouble,
      .residual = periodic.residual,
      .newton_iterations = periodic.newton_iterations,
      .linear_iterations = periodic.linear_iterations,
      // Where the solution with half the samples already satisfies the finer ones, no step is taken and only the
      // residual is known of the error.
      .sampling_difference = std::max(periodic.sampling_difference / problem.force_scale, periodic.residual)};
  if (!periodic.converged) return search;
  // The requested samples only, over all periods of the window.
  const Eigen::Index step = periodic.samples_per_cycle / options.samples_per_cycle;
  const auto in_window = [&](const Eigen::MatrixXd& values) -> Eigen::MatrixXd {
    return values(Eigen::all, Eigen::seq(0, Eigen::last, step)).replicate(1, cycles / period);
  };
  auto& windows = search.windows.emplace();
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
  return search;
}

/// Does the motion depart from the solution of a harmonic balance? It may do so too slowly for one window to show.
void examine_stability(const LumpedSystem& system, const SteadyProblem& problem, PeriodicSearch& search) {
  auto& report = *search.report;
  if (search.loses_contact() || report.method != PeriodicMethod::harmonic_balance || system.has_moving_vectors())
    return;
  report.largest_multiplier = growth_per_cycle(system, problem.mesh_frequency, search.windows->fine);
  // A thousandfold growth over a thousand cycles would pass unseen; double zero eigenvalues are 1e-7 from 1.
  constexpr double still = 1e-4;
  if (*report.largest_multiplier <= 1 + still) return;
  report.converged = false;
  report.trouble =
      fmt::format("parametric resonance: disturbances of the periodic motion grow {:.4g} times per mesh cycle",
                  *report.largest_multiplier);
  search.status = PeriodicStatus::unstable;
  search.windows.reset();
}

}  // namespace

bool PeriodicSearch::loses_contact() const {
  return windows && windows->fine.open.size() > 0 && windows->fine.open.maxCoeff() > 0;
}

PeriodicSearch find_periodic_solution(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                                      const SimulationOptions& options) {
  // Constant stiffness belongs to the harmonic balance, which also follows a loss of contact. It resolves jumps to
  // second order only.
  const bool piecewise =
      std::isfinite(system.next_jump(0)) && why_not_piecewise(system, cycles / problem.mesh_frequency).empty();
  auto search = piecewise ? solve_piecewise(system, problem, cycles, options)
                          : solve_harmonic_balance(system, problem, cycles, options);
  if (search.status == PeriodicStatus::found && options.confirm) examine_stability(system, problem, search);
  return search;
}

}  // namespace annulus::dynamics
