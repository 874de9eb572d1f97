#include "app/systems/planetary/planetary_model.h"

#include <utility>

#include "app/results/content_id.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/stage_response.h"
#include "dynamics/systems/planetary/initial_spread.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "dynamics/systems/planetary/study_point.h"

namespace annulus::app {

std::string solid_reason(const Scene& scene, const RingInput& ring) {
  return fem::solid_reason(ring_structure(ring), face_features(scene, scene.planet, "planet", ring, "ring",
                                                               scene.errors.ring_planet_misalignment));
}

std::string solid_reason(const Scene& scene) {
  return fem::solid_reason(
      {}, face_features(scene, scene.planet, "planet", scene.sun, "sun", scene.errors.sun_planet_misalignment));
}

MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry) {
  return mesh_model(scene, {.mesh = sun_planet,
                            .pair = geometry.sun_mesh(),
                            .input = scene.sun_planet,
                            .planet = scene.planet,
                            .wheel = scene.sun,
                            .planet_name = "planet",
                            .wheel_name = "sun",
                            .wheel_support_diameter = scene.sun.bore_diameter,
                            .misalignment = scene.errors.sun_planet_misalignment,
                            .mean_force = geometry.operating_point.mean_mesh_force});
}

MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& input = scene.rings.at(ring);
  const auto& made = geometry.rings.at(ring);
  return mesh_model(scene, {.mesh = ring_planet,
                            .ring = input.name,
                            .pair = made.set.ring_mesh(),
                            .input = scene.ring_planet,
                            .planet = scene.planet,
                            .wheel = input,
                            .planet_name = "planet",
                            .wheel_name = "ring",
                            .wheel_support_diameter = 2 * made.outside_radius,
                            .structure = ring_structure(input),
                            .misalignment = scene.errors.ring_planet_misalignment,
                            .mean_force = geometry.operating_point.mean_mesh_force});
}

std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry) {
  std::vector<MeshModel> models = {sun_mesh_model(scene, geometry)};
  for (std::size_t i = 0; i < scene.rings.size(); ++i) models.push_back(ring_mesh_model(scene, geometry, i));
  return models;
}

namespace {

class PlanetaryModel final : public LumpedModel {
 public:
  PlanetaryModel(dynamics::PlanetaryStage stage, dynamics::SimulationOptions simulation, const MeshResult& sun_mesh,
                 const MeshResult& ring_mesh)
      : stage_(std::move(stage)), simulation_(std::move(simulation)), sun_mesh_(sun_mesh), ring_mesh_(ring_mesh) {}

  [[nodiscard]] std::string id() const override {
    return ContentId()
        .add("response", response_id(stage_, simulation_, sun_mesh_, ring_mesh_))
        .add("method", dynamics::point_method())
        .id();
  }

  [[nodiscard]] StudyPoint answer(Answer wanted) const override {
    auto point = dynamics::evaluate_point(stage_, {.simulation = simulation_, .motion = wanted == Answer::all});
    return {.figures = {dynamics::planetary_figures(), point.figures}, .poincare = std::move(point.poincare)};
  }

  [[nodiscard]] std::optional<StartSpread> starts(int count, int seed) const override {
    const auto spread = dynamics::initial_spread(
        stage_, {.random_starts = count - 1, .seed = static_cast<std::uint64_t>(seed), .simulation = simulation_});
    const auto& specs = dynamics::planetary_figures();
    return StartSpread{.starts = count,
                       .motions = spread.attractors,
                       .low = {specs, spread.low},
                       .high = {specs, spread.high},
                       .not_steady = spread.unsteady};
  }

 private:
  dynamics::PlanetaryStage stage_;
  dynamics::SimulationOptions simulation_;
  const MeshResult &sun_mesh_, &ring_mesh_;
};

}  // namespace

std::unique_ptr<LumpedModel> planetary_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  auto stage = make_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  auto simulation = simulation_options(scene, stage);
  return std::make_unique<PlanetaryModel>(std::move(stage), std::move(simulation), sun_mesh, ring_mesh);
}

}  // namespace annulus::app
