#include "dynamics/steady_state/integration_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "core/errors.h"
#include "core/floating_point.h"
#include "dynamics/modes/modes.h"
#include "dynamics/steady_state/periodic_solution.h"
#include "dynamics/steady_state/piecewise_response.h"
#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

namespace {

constexpr int samples_for_contacts = 256;           // of a mesh cycle
constexpr double explicit_steps_of_a_period = 2.2;  // that keep the explicit method stable

/// Are there lightly damped motions too fast for the steps of BDF?
bool fast_and_light(const IntegratorChoice& choice) { return choice.least_damping > 0 && choice.least_damping < 1; }

/// Steps of BDF per mesh cycle. It follows such motions period by period until they have died out to the tolerance.
double bdf_steps(const IntegratorChoice& choice, double mesh_frequency, double periods_alive) {
  const double of_a_period = 1 / (mesh_frequency * choice.implicit_step);
  return of_a_period * (fast_and_light(choice) ? std::max(1.0, periods_alive) : 1.0);
}

/// Jumps of rectangular stiffnesses per mesh cycle.
double jumps_per_cycle(const LumpedSystem& system) {
  double jumps = 0;
  for (const auto& mesh : system.meshes())
    if (std::holds_alternative<RectangularStiffness>(mesh.excitation)) jumps += 2;
  return jumps;
}

/// Contacts that begin or end in a mesh cycle and show.
constexpr double contacts_per_cycle = 4;

/// Periods of the fastest motion within a mesh cycle, or until it has died out to the tolerance each time that one of
/// so many contacts begins or ends.
double periods_alive(const IntegratorChoice& choice, double relative_tolerance, double contacts = contacts_per_cycle) {
  const double periods = choice.explicit_steps / explicit_steps_of_a_period;
  if (!fast_and_light(choice)) return periods;
  return std::min(periods, contacts * std::log(1 / relative_tolerance) / (2 * std::numbers::pi * choice.least_damping));
}

/// A stiffness that varies, however smoothly, keeps the fast motion of a pair alive. Among many meshes it does not
/// show.
bool varies(const LumpedSystem& system) {
  int gear_meshes = 0;
  for (int m = 0; m < static_cast<int>(system.meshes().size()); ++m) gear_meshes += system.is_gear_mesh(m) ? 1 : 0;
  return gear_meshes == 1 && !std::holds_alternative<ConstantStiffness>(system.meshes().front().excitation);
}

/// Steps of a fifth-order method over those at the tolerance at which they were counted.
double finer_steps(double relative_tolerance) { return std::pow(1e-5 / relative_tolerance, 1.0 / 5); }

/// Accurate steps of the explicit method and of the L-stable one per mesh cycle, chosen by the counted steps of some
/// hundred responses of random scenes.
struct AccurateSteps {
  double explicit_method = 0, implicit_method = 0;
};
AccurateSteps accurate_steps(const LumpedSystem& system, const IntegratorChoice& choice, StiffnessCourse course,
                             double relative_tolerance, double alive) {
  const double finer = finer_steps(relative_tolerance);
  // The L-stable method steps over fast motions, except those that jumps excite, in steps that grow while they decay.
  const double jumps = jumps_per_cycle(system);
  const double followed = jumps > 0 ? 1.8 * periods_alive(choice, relative_tolerance, jumps) : 0.0;
  if (course == StiffnessCourse::sudden) return {finer * (100 + 8 * alive), finer * (400 + followed)};
  return {25 * finer, finer * (190 + followed)};
}

/// Of a smooth motion per mesh cycle: steps that are stable, and accurate where the stiffness keeps fast motions alive.
double smooth_explicit_steps(const LumpedSystem& system, const IntegratorChoice& choice, double accurate,
                             double relative_tolerance) {
  constexpr double than_stable = 1.6;
  const double finer = finer_steps(relative_tolerance);
  return std::max(accurate, choice.explicit_steps * (varies(system) ? std::max(1.0, than_stable * finer) : 1.0));
}

/// Is a motion that varies suddenly beyond the harmonic balance? With so few samples of a mesh cycle it misses tooth
/// contacts; with more it may miss the highest natural frequency, unless that is so high that it dies out in between.
bool too_few_samples(int samples, int needed) {
  constexpr int too_fast = 4;
  return samples < samples_for_contacts || (needed > 2 * samples && needed < too_fast * samples);
}

/// Mesh cycles of all starts from which other motions would be looked for, with a looser tolerance than the rest, and
/// how far backlash is within reach.
void plan_search(const LumpedSystem& system, double mesh_frequency, int period, const SimulationOptions& options,
                 StiffnessCourse course, SteadyCourse& result) {
  if (options.other_motions.starts == 0 || period > longest_searched_period) return;
  const auto meshes = mean_stiffnesses(system);
  const SteadyProblem problem{.mesh_frequency = mesh_frequency,
                              .period_in_cycles = period,
                              .force_scale = 1,
                              .stiffness = meshes.size() > 0 ? meshes.maxCoeff() : 1};
  try {
    result.reach = reach_of_backlash(system, problem);
  } catch (const InputError&) {  // the run says what is wrong
    return;
  }
  const int starts = affordable_starts(system, problem, options.integrator, options.other_motions.starts, course);
  if (result.reach > 0 && starts > 0) result.searched_cycles = (starts + 1.0) * periods_of_a_start * period;
}

}  // namespace

StiffnessCourse stiffness_course(const LumpedSystem& system) {
  const auto& meshes = system.meshes();
  const bool sudden = std::any_of(meshes.begin(), meshes.end(), [](const auto& mesh) {
    return std::holds_alternative<TableStiffness>(mesh.excitation) ||
           std::holds_alternative<RectangularStiffness>(mesh.excitation);
  });
  return sudden ? StiffnessCourse::sudden : StiffnessCourse::smooth;
}

double evaluation_seconds(const LumpedSystem& system) {
  // Measured on stages of 1 to 20 planets (18 to 63 DOFs).
  constexpr double per_dof = 1.6e-8, per_mesh = 2.4e-8, overhead = 8e-8;
  return overhead + per_dof * system.dofs() + per_mesh * static_cast<double>(system.meshes().size());
}

double SteadyCourse::possible_search_s(double per_cycle) const {
  if (reach < within_reach / 4) return 0;
  if (reach < within_reach) return searched_cycles * per_cycle;
  // Loss of contact doubles the steps.
  constexpr double of_undecided = 2.0 * longest_start / periods_of_a_start;
  return std::min(of_undecided * searched_cycles * per_cycle, longest_search_s);
}

double integration_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                           const IntegratorOptions& options, StiffnessCourse course) {
  // A step of Newton's method, measured like an evaluation.
  constexpr double per_cube = 3e-10;
  const auto n = static_cast<double>(system.dofs());
  const double evaluation = evaluation_seconds(system);
  const double newton = 2 * evaluation + per_cube * std::pow(2 * n, 3) + 1e-8 * n * n;
  // The frequency of a very small mass overflows, and the time is infinite.
  const UntrappedFloatingPoint untrapped;
  const auto choice = choose_integrator(system, options.relative_tolerance);
  if (!std::isfinite(choice.explicit_steps)) return std::numeric_limits<double>::infinity();
  const auto method = options.method == Integrator::automatic ? choice.method : options.method;
  const double alive = periods_alive(choice, options.relative_tolerance);
  const auto accurate = accurate_steps(system, choice, course, options.relative_tolerance, alive);
  switch (method) {
    case Integrator::runge_kutta_4:
      return cycles / (mesh_frequency * options.fixed_step) * 4 * evaluation;
    case Integrator::cvode_bdf:
      return cycles * 2 * std::max(accurate.explicit_method, bdf_steps(choice, mesh_frequency, alive)) * newton;
    case Integrator::arkode_implicit: {
      // Seven stages, each with some iterations, and the factorisation that they share.
      constexpr double stages = 25, per_step = 1.2e-5, per_square = 8e-8;
      return cycles * accurate.implicit_method * (stages * evaluation + per_step + per_square * n * n);
    }
    case Integrator::cvode_adams:
    case Integrator::automatic:
    case Integrator::arkode_explicit:
      break;
  }
  // Accuracy follows the fastest motion while it is alive, stability always.
  const double died_out = choice.explicit_steps - explicit_steps_of_a_period * alive;
  const double steps = course == StiffnessCourse::smooth
                           ? smooth_explicit_steps(system, choice, accurate.explicit_method, options.relative_tolerance)
                           : accurate.explicit_method + std::max(0.0, died_out);
  // With those at events. Adams takes fewer, in steps that are far shorter where motions are excited.
  const double stages = method == Integrator::cvode_adams ? 25 : 7;
  return cycles * steps * stages * evaluation;
}

SteadyCourse steady_course(const LumpedSystem& system, double mesh_frequency, int period,
                           const SimulationOptions& options, StiffnessCourse course) {
  constexpr double unsteady_comparison = 170, few_windows = 3;
  // Of a window, with ten times the tolerance or half the fixed steps.
  const double again = options.integrator.fixed_step > 0 ? 2 : std::pow(10, -1.0 / 5);
  const double looser = options.estimate_error ? again : 0;
  const WindowLength length = window_length(period, options);
  const int window = length.cycles;
  if (options.mesh_cycles) {
    const auto given = static_cast<double>(*options.mesh_cycles);
    return {.cycles = given + looser * window, .compared_cycles = given, .samples = options.samples_per_cycle};
  }
  if (!length.whole)
    return {
        .cycles = (2 + looser) * window, .compared_cycles = unsteady_comparison, .samples = options.samples_per_cycle};
  SteadyCourse result;
  plan_search(system, mesh_frequency, period, options, course, result);
  const int most = std::max(options.samples_per_cycle, most_samples_per_cycle(period));
  // Doubled until they follow tooth contacts and the highest natural frequency.
  int samples = std::min(options.samples_per_cycle, most);
  const UntrappedFloatingPoint untrapped;  // see above
  const double highest = modes(system, mean_stiffnesses(system)).modes.back().frequency;
  const double needed = std::min(4 * highest / mesh_frequency, 1e9);
  const double wanted = course == StiffnessCourse::sudden ? std::max<double>(needed, samples_for_contacts) : needed;
  while (2 * samples <= most && samples < wanted) samples *= 2;
  result.samples = samples;
  constexpr double any = 5e-4, per_sample = 2e-6;  // s; of a mesh
  const bool moving = !system.has_fixed_directions();
  if (!moving) result.balance_s = any + per_sample * static_cast<double>(system.meshes().size()) * period * samples;
  const auto integrate = [&](double windows, double compared) {
    result.cycles = (windows + looser) * window;
    result.compared_cycles = compared * window;
  };
  double damping = 0;
  for (const auto& mesh : system.meshes()) damping += mesh.damping;
  const double until_two_agree = damping > 0 ? few_windows : options.max_windows;
  const double seconds = window / mesh_frequency;
  const bool jumps = std::isfinite(system.next_jump(0)) && why_not_piecewise(system, seconds).empty();
  // Jumps of constant stiffness are solved exactly.
  const bool balanced = course == StiffnessCourse::sudden && !jumps;
  const bool too_few = balanced && too_few_samples(samples, static_cast<int>(needed));
  const bool jumps_between = balanced && std::isfinite(system.next_jump(0));
  const bool confirmed = options.confirmation == Confirmation::always ||
                         (options.confirmation == Confirmation::where_needed && jumps_between);
  const bool unresolved = confirmed && too_few;
  if (jumps && too_fast_for_piecewise(system, seconds, window))
    integrate(until_two_agree + 1, 0);
  else if (unresolved || moving || options.steady_state == SteadyState::time_integration)
    integrate(until_two_agree, few_windows);
  else if (confirmed)
    integrate(1, 0);
  return result;
}

}  // namespace annulus::dynamics
