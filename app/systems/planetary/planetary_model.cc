#include "app/systems/planetary/planetary_model.h"

#include <algorithm>
#include <utility>

#include "app/results/cached_value.h"
#include "app/systems/planetary/stage_response.h"
#include "dynamics/systems/planetary/initial_spread.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry) {
  std::vector<MeshModel> models = {sun_mesh_model(scene, geometry)};
  for (std::size_t i = 0; i < scene.rings.size(); ++i) models.push_back(ring_mesh_model(scene, geometry, i));
  return models;
}

namespace {

StartSpread spread_of(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& simulation, int count,
                      int seed) {
  const auto spread = dynamics::initial_spread(
      stage, {.random_starts = count - 1, .seed = static_cast<std::uint64_t>(seed), .simulation = simulation});
  const auto& specs = dynamics::planetary_figures();
  StartSpread result{.starts = count, .motions = spread.attractors, .not_steady = spread.unsteady};
  for (const auto& start : spread.starts) {
    const FigureRow row(specs,
                        dynamics::figures(dynamics::PointFigures{start.sun_planet, start.ring_planet, start.steady}));
    if (result.low.empty()) result.low = result.high = row;
    for (const auto& spec : specs) {
      result.low.set(spec.key, std::min(result.low.value(spec.key), row.value(spec.key)));
      result.high.set(spec.key, std::max(result.high.value(spec.key), row.value(spec.key)));
    }
  }
  return result;
}

}  // namespace

std::unique_ptr<LumpedModel> planetary_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  const auto stage = make_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  const auto simulation = simulation_options(scene, stage);
  return std::make_unique<LumpedModel>(
      identity_of(response_id(stage, simulation, sun_mesh, ring_mesh), std::string(dynamics::point_method())),
      [stage, simulation](Answer wanted) -> StudyPoint {
        auto f = dynamics::evaluate_point(stage, {.simulation = simulation, .motion = wanted == Answer::all});
        auto figures = dynamics::figures(f);
        if (wanted == Answer::all) figures.add(dynamics::motion_figures(f));
        return {.figures = {dynamics::planetary_figures(), figures}, .poincare = std::move(f.poincare)};
      },
      [stage, simulation](int count, int seed) { return spread_of(stage, simulation, count, seed); });
}

}  // namespace annulus::app
