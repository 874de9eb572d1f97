#include "dynamics/steady_state/periodic_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "dynamics/modes/growth.h"
#include "dynamics/modes/modes.h"
#include "dynamics/steady_state/floquet.h"
#include "dynamics/steady_state/piecewise_response.h"
#include "dynamics/steady_state/sampled_meshes.h"

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

/// The exact solution of a system whose stiffness jumps and is constant between.
PeriodicSearch solve_piecewise(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                               const SimulationOptions& options) {
  const double duration = cycles / problem.mesh_frequency;
  auto exact = piecewise_response(system, duration, cycles, options.samples_per_cycle);
  exact.sampling_difference = exact.residual;
  PeriodicSearch search(exact);
  if (!exact.converged) return search;
  ResponseWindow& fine = search.windows.emplace().fine = std::move(exact);
  fine.after_jump = samples_after_jumps(system, duration, fine.time.size());
  // The jumps of one period of the excitation over the whole window.
  const Eigen::Index jumps = fine.jump_time.size(), periods = cycles / exact.solved_cycles;
  const Eigen::VectorXd first = fine.jump_time;
  fine.jump_time.resize(periods * jumps);
  for (Eigen::Index i = 0; i < periods; ++i)
    fine.jump_time.segment(i * jumps, jumps) =
        first.array() + static_cast<double>(i) * duration / static_cast<double>(periods);
  fine.force_before = fine.force_before.replicate(1, periods).eval();
  fine.force_after = fine.force_after.replicate(1, periods).eval();
  return search;
}

/// Higher where the period is short. Long periods have as many as any run begins with, which costs far less than to
/// integrate them in time.
int samples_within(int period, int most_of_a_period) {
  constexpr int least = 32, most = 512;
  return std::clamp(most_of_a_period / period, least, most);
}

/// The error of a sampling is about a third of the change when the samples are halved. A loose tolerance leaves no room
/// for that third: vibrations that a sampling lacks are seen late.
double sampling_tolerance(double steady_tolerance) {
  constexpr double tight = 3e-3;
  return std::min(3 * steady_tolerance, std::max(steady_tolerance, tight));
}

/// `period`: mesh cycles that are sampled.
PeriodicOptions balance_options(const SteadyProblem& problem, int period, const SimulationOptions& options) {
  PeriodicOptions balance = options.periodic;
  balance.samples_per_cycle = options.samples_per_cycle;
  if (options.sampling == Sampling::as_needed) {
    balance.sampling_tolerance = sampling_tolerance(options.steady_tolerance) * problem.force_scale;
    // Newton's method stores dozens of vectors of unknowns, a look stores a few.
    balance.max_samples_per_cycle = most_samples_per_cycle(period);
    balance.max_samples_ahead = samples_within(period, 1 << 15);
  }
  return balance;
}

PeriodicSearch solve_harmonic_balance(const LumpedSystem& system, const SteadyProblem& problem, int cycles,
                                      const SimulationOptions& options) {
  const int period = problem.period_in_cycles;
  const double duration = period / problem.mesh_frequency;
  PeriodicResponse periodic;
  const auto angles = period > long_window ? two_frequencies(system, problem.mesh_frequency, period) : std::nullopt;
  // A few values of the second angle take a multiple of the first one's cycles. Studies of many points have half the
  // samples.
  const int times = options.confirmation == Confirmation::always ? 2 : 4;
  if (angles)
    periodic = two_frequency_response(system, *angles, duration, period,
                                      balance_options(problem, times * angles->cycles, options));
  if (!periodic.converged)
    periodic = periodic_response(system, duration, period, balance_options(problem, period, options));
  // Where the solution with half the samples already satisfies the finer ones, no step is taken and only the residual
  // is known of the error.
  periodic.sampling_difference = std::max(periodic.largest_difference() / problem.force_scale, periodic.residual);
  PeriodicSearch search(periodic);
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
  windows.fine.back = std::move(periodic.back);
  const bool ahead = periodic.finer_difference > periodic.coarse_difference;
  windows.compared.emplace();
  windows.compared->samples_per_cycle = ahead ? options.samples_per_cycle : options.samples_per_cycle / 2;
  windows.compared->force = in_window(ahead ? periodic.finer_force : periodic.coarse_force);
  if (step > 1) windows.fine.dense_force = std::move(periodic.force);
  windows.fine.dense_per_sample = static_cast<int>(step);
  return search;
}

/// Largest modulus of the Floquet multipliers of one mesh cycle, the first one of the window, about a periodic motion
/// without loss of contact. Above 1 small disturbances grow (parametric resonance), below 1 they die out. Undamped
/// motions stay at 1 to rounding.
double growth_per_cycle(const LumpedSystem& system, double mesh_frequency, const ResponseWindow& window) {
  const Eigen::Index samples = window.samples_per_cycle;
  require(samples > 0 && window.displacement.cols() >= samples,
          fmt::format("a window of {} samples must hold a mesh cycle of {}", window.displacement.cols(), samples));
  const Eigen::MatrixXd b = system.mesh_vectors();
  SampledMeshes meshes(system, 1 / mesh_frequency, samples);
  Eigen::MatrixXd force;
  meshes.evaluate(window.displacement.leftCols(samples).transpose() * b,
                  window.velocity.leftCols(samples).transpose() * b, force);
  const Eigen::VectorXd mean = mean_stiffnesses(system);
  const Eigen::VectorXcd multipliers = floquet_multipliers(system, mean, meshes, 1 / mesh_frequency);
  const double growth = multipliers.size() > 0 ? std::abs(multipliers[0]) : 0;
  const double w = 2 * std::numbers::pi * modes(system, mean).modes.back().frequency;
  const double rounding = 100 * std::numeric_limits<double>::epsilon() * (1 + w / mesh_frequency);
  return growth <= 1 + rounding ? std::min(growth, 1.0) : growth;
}

/// Does the motion depart from the solution of a harmonic balance? It may do so too slowly for one window to show.
void examine_stability(const LumpedSystem& system, const SteadyProblem& problem, PeriodicSearch& search) {
  auto& report = *search.report;
  if (search.loses_contact() || report.method == PeriodicMethod::piecewise || !system.has_fixed_directions()) return;
  report.largest_multiplier = growth_per_cycle(system, problem.mesh_frequency, search.windows->fine);
  if (*report.largest_multiplier <= 1 + unseen_growth) return;
  report.converged = false;
  report.trouble =
      fmt::format("parametric resonance: disturbances of the periodic motion grow {:.4g} times per mesh cycle",
                  *report.largest_multiplier);
  search.status = PeriodicStatus::unstable;
  search.windows.reset();
}

}  // namespace

int most_samples_per_cycle(int period) { return samples_within(period, 1 << 13); }

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
  if (search.status == PeriodicStatus::found && options.confirmation == Confirmation::always)
    examine_stability(system, problem, search);
  return search;
}

}  // namespace annulus::dynamics
