#include "dynamics/systems/planetary/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/quasi_static_forces.h"

namespace annulus::dynamics {

namespace {

void check_simulation(const PlanetaryStage& stage) {
  stage.check();
  if (!(stage.mesh_frequency() > 0))
    throw InputError(
        fmt::format("a time response needs a carrier that turns against the ring; their speeds are {} and {} rad/s",
                    stage.carrier_speed, stage.ring_speed));
  if (!(stage.sun_torque > 0))
    throw InputError(
        fmt::format("a time response needs a positive sun torque (drive flanks loaded), not {} N m", stage.sun_torque));
  check_ripples(stage.rotors, stage.shaft_ends());
}

/// Mean over each mesh cycle; columns span whole cycles.
Eigen::MatrixXd cycle_means(const Eigen::MatrixXd& values, int cycles) {
  const Eigen::Index samples = values.cols() / cycles;
  Eigen::MatrixXd means(values.rows(), cycles);
  for (int c = 0; c < cycles; ++c) means.col(c) = values.middleCols(c * samples, samples).rowwise().mean();
  return means;
}

void set_figures(const PlanetaryStage& stage, const SimulationOptions& options, const SteadyResponse& found,
                 DynamicResponse& response) {
  int positions = options.samples_per_cycle;
  if (response.window_cycles > long_window) positions = std::min(positions, enough_samples(response.window_cycles));
  const QuasiStatic path = quasi_static(stage, positions, options.max_window_cycles);
  const Eigen::Index n = stage.planets();
  const double mean = response.mean_mesh_force;
  const auto system = assemble(stage);
  // Between the positions beside the highest ones.
  const auto closer = [&](const Eigen::MatrixXd& force, Eigen::Index first) {
    constexpr std::size_t most = 2;
    constexpr int pieces = 8;
    const double step = 1 / (positions * stage.mesh_frequency());
    std::vector<Eigen::MatrixXd> list;
    for (const Eigen::Index top : highest_shares(force, most)) {
      const double from = std::max(0.0, (static_cast<double>(top) - 1) * step);
      const auto around = static_path(system, Eigen::VectorXd::LinSpaced(2 * pieces + 1, from, from + 2 * step));
      list.push_back(around.force.middleRows(first, n));
    }
    return list;
  };
  response.sun_planet = {load_sharing(found, 0, n, path.sun_force, closer(path.sun_force, 0)),
                         branch_results(found, 0, n, mean)};
  response.ring_planet = {load_sharing(found, n, n, path.ring_force, closer(path.ring_force, n)),
                          branch_results(found, n, n, mean)};
}

/// See DynamicResponse::force_balance_relative.
double force_balance(const PlanetaryStage& stage, const LumpedSystem& system, const SteadyResponse& found) {
  // Of the ring where the sun is held: its load reaches the ring meshes in the same sense.
  const bool sun = stage.held != geometry::StageMember::sun;
  const Eigen::VectorXd turning = turning_as_one(system, stage.rotors, sun ? "sun" : "ring");
  const double duration = found.window_cycles / stage.mesh_frequency();
  const Eigen::MatrixXd all = averaging_force(found.best);
  const double forces = all.middleRows(sun ? 0 : stage.planets(), stage.planets()).colwise().sum().mean();
  const double support = turning.dot(system.stiffness() * found.best.displacement.rowwise().mean()) +
                         turning.dot(system.damping() * (found.end.q - found.begin.q)) / duration;
  const double inertia = turning.dot(system.mass() * (found.end.v - found.begin.v)) / duration;
  double load = 0;
  for (const double t : found.best.time)
    load += turning.dot(system.load_at(t)) / static_cast<double>(found.best.time.size());
  return std::abs((forces + support + inertia) / load - 1);
}

}  // namespace

LumpedCase lumped_case(const PlanetaryStage& stage) {
  check_simulation(stage);
  return {assemble(stage),
          {.mesh_frequency = stage.mesh_frequency(),
           .period_in_cycles = stage.error_period(),
           .force_scale = stage.mean_mesh_force(),
           .stiffness = mean_stiffness(stage.sun_mesh)},
          turning_of(stage.shaft_ends())};
}

DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options) {
  const auto [system, problem, turning] = lumped_case(stage);
  DynamicResponse response;
  response.mesh_frequency = problem.mesh_frequency;
  response.mean_mesh_force = problem.force_scale;
  auto found = steady_response(system, problem, options);
  static_cast<SteadyOutcome&>(response) = static_cast<const SteadyOutcome&>(found);
  response.cycle_force = cycle_means(
      averaging_force(found.best).topRows(2 * static_cast<Eigen::Index>(stage.planets())), found.window_cycles);
  response.force_balance_relative = force_balance(stage, system, found);
  set_figures(stage, options, found, response);
  response.bodies = body_results(stage, system, found);
  response.shafts = shaft_results(system, stage.rotors, stage.shaft_ends(), found);
  if (options.keep_series) response.series = series_of(system, std::move(found.best));
  return response;
}

QuasiStatic quasi_static(const PlanetaryStage& stage, int positions_per_cycle, int max_cycles) {
  if (positions_per_cycle < 1 || max_cycles < 1)
    throw InputError(fmt::format("quasi-static analysis needs at least one position and one mesh cycle, not {} and {}",
                                 positions_per_cycle, max_cycles));
  if (!(stage.mesh_frequency() > 0))
    throw InputError(
        fmt::format("quasi-static positions need a carrier that turns against the ring; their speeds are {} and {} "
                    "rad/s",
                    stage.carrier_speed, stage.ring_speed));
  const Eigen::MatrixXd force = quasi_static_forces(assemble(stage), stage.mesh_frequency(),
                                                    std::min(stage.error_period(), max_cycles), positions_per_cycle);
  return {force.topRows(stage.planets()), force.middleRows(stage.planets(), stage.planets())};
}

}  // namespace annulus::dynamics
