#include "dynamics/systems/two_k_v/two_k_v_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/errors.h"
#include "dynamics/figures/peaks.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/shooting.h"
#include "dynamics/system/periods.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

namespace {

/// The output's error as a linear form of the DOFs.
Eigen::VectorXd error_form(const TwoKVStage& stage, const LumpedSystem& system) {
  const Eigen::VectorXd radii = dof_radii(stage, system);
  Eigen::VectorXd form = Eigen::VectorXd::Zero(system.dofs());
  if (const int i = system.find("output_u"); i >= 0) form[i] = 1 / radii[i];
  if (const int i = system.find("input_u"); i >= 0) form[i] = -1 / (radii[i] * stage.ratio());
  return form;
}

OutputError output_error(const Eigen::VectorXd& form, const SteadyResponse& steady) {
  OutputError error;
  error.series = steady.best.displacement.transpose() * form;
  error.mean = error.series.mean();
  const auto swing_in = [&](const std::optional<ResponseWindow>& window) {
    const auto& motion = window && window->displacement.size() ? window->displacement : steady.best.displacement;
    return swing_of(form.transpose() * motion);
  };
  error.peak_to_peak = figure(swing_of(error.series.transpose()), {swing_in(steady.before), swing_in(steady.loose)});
  return error;
}

/// Of the reducer by itself.
OutputError quasi_static_error(TwoKVStage stage, int positions_per_cycle, Eigen::VectorXd& time) {
  stage.rotors.clear();
  const auto system = assemble(stage);
  const Eigen::VectorXd form = error_form(stage, system);
  const int count = period_in_crank_turns(stage) * stage.planet_teeth * positions_per_cycle;
  const double period = period_in_crank_turns(stage) / stage.crank_frequency();
  time = Eigen::VectorXd::LinSpaced(count, 0, count - 1) * period / count;
  OutputError error;
  const auto path = static_path(system, time);
  error.series.resize(count);
  for (int i = 0; i < count; ++i) error.series[i] = form.dot(path.displacement.col(i));
  error.mean = error.series.mean();
  error.peak_to_peak = figure(swing_of(error.series.transpose()), {});
  return error;
}

enum class Times { sampled, closest };

/// Of the resultant of two meshes, from the `first` one on.
Peak largest_resultant(const ResponseWindow& window, Eigen::Index first, Times times) {
  const auto resultant = [first](const Eigen::MatrixXd& force) -> Eigen::RowVectorXd {
    return force.middleRows(first, 2).colwise().norm();
  };
  const bool closer = times == Times::closest && window.dense_force.size() > 0;
  auto largest = peak_of(resultant(closer ? window.dense_force : window.force),
                         closer ? window.dense_after_jump : window.after_jump);
  if (!window.jumps()) return largest;
  for (const auto* side : {&window.force_before, &window.force_after}) {
    const double jump = resultant(*side).maxCoeff();
    largest = higher(largest, {jump, jump});
  }
  return largest;
}

/// The two linear meshes of every bearing follow the toothed ones, tangential before radial.
std::vector<ArcBearingResult> bearing_results(const TwoKVStage& stage, const SteadyResponse& steady) {
  std::vector<ArcBearingResult> results;
  const Eigen::MatrixXd averaging = averaging_force(steady.best);
  Eigen::Index m = stage.cranks + stage.arc_gears;
  for (int i = 0; i < stage.cranks; ++i)
    for (int j = 0; j < stage.arc_gears; ++j, m += 2) {
      const auto sampled = largest_resultant(steady.best, m, Times::sampled);
      // Behind jumps forces vibrate between the samples.
      auto largest = steady.best.jumps() ? figure(largest_resultant(steady.best, m, Times::closest), {sampled})
                                         : figure(sampled, {});
      for (const auto* other : {&steady.before, &steady.loose})
        if (*other) largest.error += std::abs(sampled.refined - largest_resultant(**other, m, Times::sampled).refined);
      results.push_back({i, j, largest, averaging.middleRows(m, 2).colwise().norm().mean()});
    }
  return results;
}

std::optional<double> torque_balance(const TwoKVStage& stage, const LumpedSystem& system,
                                     const SteadyResponse& steady) {
  if (stage.input_support != 0) return std::nullopt;
  const double torque = stage.output_torque / stage.ratio();
  const double meshes =
      averaging_force(steady.best).topRows(stage.cranks).colwise().sum().mean() * stage.sun_base_radius();
  double momentum = 0;
  const double span = steady.end.time - steady.begin.time;
  if (span > 0) {
    Eigen::VectorXd turning = turning_as_one(system, stage.rotors, "input");
    turning[system.find("sun_u")] = 1;
    momentum = turning.dot(system.mass() * (steady.end.v - steady.begin.v)) * stage.sun_base_radius() / span;
  }
  return std::abs(meshes + momentum - torque) / torque;
}

/// Puts the start on the periodic orbit where shooting finds it.
std::optional<double> shoot_for_start(const TwoKVStage& stage, const LumpedSystem& system, const SteadyProblem& problem,
                                      SimulationOptions& options) {
  if (options.start || options.mesh_cycles || problem.period_in_cycles > options.max_window_cycles) return std::nullopt;
  if (options.integrator.method == Integrator::runge_kutta_4)
    check_fixed_step(system, problem.mesh_frequency, options.integrator.fixed_step);
  ShootingOptions shooting;
  shooting.displacement = problem.force_scale / problem.stiffness;
  shooting.tolerance = 0.1 * options.steady_tolerance * shooting.displacement;
  shooting.rate = 2 * std::numbers::pi * problem.mesh_frequency;
  shooting.integrator = options.integrator;
  if (!shooting.integrator.absolute_tolerance)
    shooting.integrator.absolute_tolerance =
        0.1 * shooting.integrator.relative_tolerance * problem.force_scale / problem.stiffness;
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const SystemState guess{0, solver.solve(0, workspace), Eigen::VectorXd::Zero(system.dofs())};
  const auto found = shoot(system, problem.period_in_cycles / problem.mesh_frequency, guess, shooting);
  const bool rigid_motion_exists = stage.input_support == 0 && stage.output_support == 0;
  const double multiplier = std::abs(found.multipliers[rigid_motion_exists ? 2 : 0]);
  // From an unstable orbit the motion departs sooner or later. Time integration from elsewhere finds its destination.
  constexpr double accuracy = 1e-3;  // of multipliers from differences; an undamped motion neither grows nor dies
  if (found.converged && multiplier <= 1 + accuracy) options.start = found.start;
  return multiplier;
}

}  // namespace

int period_in_crank_turns(const TwoKVStage& stage) {
  const auto turns = [](const MeshExcitation& excitation, int cycles_per_turn) {
    const int period = period_in_cycles(excitation);
    return period / std::gcd(period, cycles_per_turn);
  };
  const int period = std::lcm(turns(stage.sun_mesh, stage.planet_teeth), turns(stage.arc_mesh, stage.arc_teeth));
  if (stage.rotors.empty() || stage.output_speed == 0) return period;
  return common_period(period, ripple_period(stage.rotors, stage.shaft_ends(), stage.crank_frequency()));
}

LumpedCase lumped_case(const TwoKVStage& stage) {
  stage.check();
  if (!(stage.output_speed > 0))
    throw InputError(
        fmt::format("2K-V stage: a time response needs an output speed above zero, not {} rad/s", stage.output_speed));
  if (!(stage.output_torque > 0))
    throw InputError(
        fmt::format("2K-V stage: a time response needs an output torque above zero, not {} N m", stage.output_torque));
  if (stage.input_support == rigid && stage.output_support == rigid)
    throw InputError(
        fmt::format("2K-V stage: with input and output fixed the torque of {} N m has no effect; leave one end free",
                    stage.output_torque));
  return {assemble(stage),
          {stage.sun_mesh_frequency(), times_period(stage.planet_teeth, period_in_crank_turns(stage)),
           stage.mean_arc_mesh_force(), mean_stiffness(stage.arc_mesh)},
          turning_of(stage.shaft_ends())};
}

TwoKVResponse simulate(const TwoKVStage& stage, const SimulationOptions& given) {
  auto options = given;
  const auto [system, problem, turning] = lumped_case(stage);
  const double arc_force = problem.force_scale;
  TwoKVResponse response;
  response.largest_multiplier = shoot_for_start(stage, system, problem, options);
  auto steady = steady_response(system, problem, options);
  static_cast<SteadyOutcome&>(response) = static_cast<const SteadyOutcome&>(steady);
  response.crank_frequency = stage.crank_frequency();
  response.sun_mesh_frequency = stage.sun_mesh_frequency();
  response.arc_mesh_frequency = stage.arc_mesh_frequency();
  response.mean_sun_force = stage.mean_sun_mesh_force();
  response.mean_arc_force = arc_force;
  response.crank_turns = steady.window_cycles / stage.planet_teeth;

  const Eigen::VectorXd form = error_form(stage, system);
  response.dynamic = output_error(form, steady);
  constexpr int static_positions = 16;  // per sun mesh cycle
  response.quasi_static = quasi_static_error(stage, static_positions, response.quasi_static_time);
  response.sun_planet = branch_results(steady, 0, stage.cranks, response.mean_sun_force);
  response.arc_pins = branch_results(steady, stage.cranks, stage.arc_gears, arc_force,
                                     stage.sun_mesh_frequency() / stage.arc_mesh_frequency());
  response.arc_bearings = bearing_results(stage, steady);
  response.shafts = shaft_results(system, stage.rotors, stage.shaft_ends(), steady);
  response.torque_balance_relative = torque_balance(stage, system, steady);
  if (steady.window_cycles % stage.planet_teeth == 0)
    response.error_spectrum = spectrum(response.dynamic.series, response.crank_turns);
  if (options.keep_series) response.series = series_of(system, std::move(steady.best));
  return response;
}

}  // namespace annulus::dynamics
