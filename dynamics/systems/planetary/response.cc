#include "dynamics/systems/planetary/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "dynamics/systems/planetary/response_evaluation.h"

namespace annulus::dynamics {

namespace {

void require_speed(const PlanetaryStage& stage, const char* analysis) {
  if (!(stage.carrier_speed > 0))
    throw InputError(fmt::format("{} needs a carrier speed above zero, not {} rad/s", analysis, stage.carrier_speed));
}

void check_simulation(const PlanetaryStage& stage) {
  stage.check();
  require_speed(stage, "a time response");
  if (!(stage.sun_torque > 0))
    throw InputError(
        fmt::format("a time response needs a positive sun torque (drive flanks loaded), not {} N m", stage.sun_torque));
}

/// Mean over each mesh cycle; columns span whole cycles.
Eigen::MatrixXd cycle_means(const Eigen::MatrixXd& values, int cycles) {
  const Eigen::Index samples = values.cols() / cycles;
  Eigen::MatrixXd means(values.rows(), cycles);
  for (int c = 0; c < cycles; ++c) means.col(c) = values.middleCols(c * samples, samples).rowwise().mean();
  return means;
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

}  // namespace

DynamicResponse simulate(const PlanetaryStage& stage, const SimulationOptions& options) {
  check_simulation(stage);
  DynamicResponse response;
  response.mesh_frequency = stage.mesh_frequency();
  response.mean_mesh_force = stage.mean_mesh_force();
  const LumpedSystem system = assemble(stage);
  const SteadyProblem problem{.mesh_frequency = response.mesh_frequency,
                              .period_in_cycles = stage.error_period(),
                              .force_scale = response.mean_mesh_force,
                              .stiffness = mean_stiffness(stage.sun_mesh),
                              .start = options.start};
  auto found = steady_response(system, problem, options);
  static_cast<SteadyOutcome&>(response) = found.outcome();
  response.cycle_force = cycle_means(averaging_force(found.best), found.window_cycles);
  response.force_balance_relative =
      force_balance(stage, system, found.best, found.begin, found.end, found.window_cycles);
  set_figures(stage, options,
              {found.best, found.before ? *found.before : found.best, found.loose ? *found.loose : found.best,
               response.mean_mesh_force},
              response);
  if (options.keep_series) response.series = series_of(system, std::move(found.best));
  return response;
}

PeriodicResponse periodic_response(const PlanetaryStage& stage, const PeriodicOptions& options) {
  require_speed(stage, "a periodic response");
  const int cycles = stage.error_period();
  return periodic_response(assemble(stage), cycles / stage.mesh_frequency(), cycles, options);
}

PiecewiseResponse piecewise_response(const PlanetaryStage& stage, const PiecewiseOptions& options) {
  require_speed(stage, "a piecewise linear response");
  const int cycles = stage.error_period();
  return piecewise_response(assemble(stage), cycles / stage.mesh_frequency(), cycles, options);
}

}  // namespace annulus::dynamics
