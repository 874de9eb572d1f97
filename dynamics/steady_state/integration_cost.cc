#include "dynamics/steady_state/integration_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/floating_point.h"
#include "dynamics/steady_state/piecewise_response.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

namespace {

/// Steps of BDF per mesh cycle. It follows fast motions that are lightly damped, period by period, until they have died
/// out to the tolerance; some four contacts that begin or end excite them in every mesh cycle.
double bdf_steps(const IntegratorChoice& choice, double mesh_frequency, double relative_tolerance) {
  const double of_a_period = 1 / (mesh_frequency * choice.implicit_step);
  if (!(choice.least_damping > 0) || choice.least_damping >= 1) return of_a_period;
  constexpr double explicit_steps_of_a_period = 2.2, contacts = 4;
  const double periods = choice.explicit_steps / explicit_steps_of_a_period;
  const double until_died_out =
      contacts * std::log(1 / relative_tolerance) / (2 * std::numbers::pi * choice.least_damping);
  return of_a_period * std::max(1.0, std::min(periods, until_died_out));
}

}  // namespace

double integration_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                           const IntegratorOptions& options) {
  // Measured on stages of 1 to 20 planets (18 to 63 DOFs): a right-hand side, and a step of Newton's method.
  constexpr double per_dof = 1.6e-8, per_mesh = 2.4e-8, overhead = 8e-8, per_cube = 3e-10;
  const auto n = static_cast<double>(system.dofs()), meshes = static_cast<double>(system.meshes().size());
  const double evaluation = overhead + per_dof * n + per_mesh * meshes;
  const double newton = 2 * evaluation + per_cube * std::pow(2 * n, 3) + 1e-8 * n * n;
  // The frequency of a very small mass overflows, and the time is infinite.
  const UntrappedFloatingPoint untrapped;
  const auto choice = choose_integrator(system, options.relative_tolerance);
  if (!std::isfinite(choice.explicit_steps)) return std::numeric_limits<double>::infinity();
  const auto method = options.method == Integrator::automatic ? choice.method : options.method;
  const double accurate = 40 * std::pow(1e-6 / options.relative_tolerance, 1.0 / 5);
  switch (method) {
    case Integrator::runge_kutta_4:
      return cycles / (mesh_frequency * options.fixed_step) * 4 * evaluation;
    case Integrator::cvode_bdf:
      return cycles * 2 * std::max(accurate, bdf_steps(choice, mesh_frequency, options.relative_tolerance)) * newton;
    case Integrator::arkode_implicit:
      // Some 300 steps whatever the speed, seven stages each, and again with a looser tolerance.
      return cycles * 300 / 40 * accurate * 7 * 1.8 * newton;
    case Integrator::automatic:
    case Integrator::cvode_adams:
    case Integrator::arkode_explicit:
      break;
  }
  return cycles * std::max(accurate, choice.explicit_steps) * 6 * evaluation;
}

double integrated_cycles(const LumpedSystem& system, double mesh_frequency, int period,
                         const SimulationOptions& options) {
  if (options.mesh_cycles) return *options.mesh_cycles;
  const auto [window, whole] = window_length(period, options);
  if (!whole) return 2.0 * window;
  double damping = 0;
  for (const auto& mesh : system.meshes()) damping += mesh.damping;
  if (damping == 0) return static_cast<double>(options.max_windows) * window;
  constexpr double until_two_agree = 4;
  const double seconds = window / mesh_frequency;
  const bool jumps = std::isfinite(system.next_jump(0)) && why_not_piecewise(system, seconds).empty();
  if (jumps && too_fast_for_piecewise(system, seconds, window)) return until_two_agree * window;
  return options.confirmation == Confirmation::always ? window : 0;
}

}  // namespace annulus::dynamics
