#include "dynamics/systems/planetary/study_point.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "dynamics/figures/common_figures.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "dynamics/systems/planetary/planetary_modes.h"

namespace annulus::dynamics {

namespace {

/// Samples per mesh cycle of figures that are compared, at most `wanted` where all is smooth. Jumps set off vibrations
/// of the highest modes, whose peaks need close samples in a time integration (measured: 32 samples err by 1 %).
int samples_of_point(const PlanetaryStage& stage, int wanted) {
  constexpr int after_jumps = 128;
  for (const auto* mesh : {&stage.sun_mesh, &stage.ring_mesh})
    if (std::holds_alternative<RectangularStiffness>(*mesh) && stage.error_period() <= long_window)
      return std::max(wanted, after_jumps);
  return std::min(wanted, enough_samples(stage.error_period()));
}

/// By harmonic balance, confirmed where needed alone: with loss of contact several motions may exist, and time
/// integration decides between them.
DynamicResponse response_of_point(const PlanetaryStage& stage, const PointOptions& options) {
  SimulationOptions simulation = options.simulation;
  simulation.estimate_error = false;  // the nominal run estimates the error; a study compares
  simulation.confirmation = Confirmation::where_needed;
  // Integrating windows of thousands of mesh cycles costs a hundred harmonic balances. Their error is about a third of
  // the difference to half the samples, and the difference is stated.
  if (stage.error_period() > long_window) simulation.confirm_beyond *= 5;
  simulation.keep_series = options.motion;
  if (!options.motion && !simulation.mesh_cycles)
    simulation.samples_per_cycle = samples_of_point(stage, simulation.samples_per_cycle);
  return simulate(stage, simulation);
}

}  // namespace

PointFigures evaluate_point(const PlanetaryStage& stage, const PointOptions& options) {
  const auto response = response_of_point(stage, options);
  PointFigures point{.figures = figures(response), .window_cycles = response.window_cycles, .end = response.end};
  if (!options.motion) return point;
  const auto system = assemble(stage);
  const auto& series = response.series;
  const Eigen::MatrixXd delta = deflections(system, series.time, series.displacement);
  point.figures.add(frequency_figures(modes(stage), planetary_frequencies, Multiples::once));
  const Eigen::Index per_cycle = series.time.size() / response.window_cycles;
  for (int c = 0; c < std::min(options.poincare_cycles, response.window_cycles); ++c)
    point.poincare.push_back({series.force(0, c * per_cycle), delta(0, c * per_cycle)});
  return point;
}

const char* point_method() { return "harmonic balance 5"; }

}  // namespace annulus::dynamics
