#include "app/systems/planetary/planetary_model.h"

#include <utility>

#include "app/results/cached_value.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/space_stage.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "dynamics/friction/friction_losses.h"
#include "dynamics/systems/planetary/initial_spread.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "dynamics/systems/planetary/space_motion.h"
#include "dynamics/systems/planetary/study_point.h"

namespace annulus::app {

std::string solid_reason(const Scene& scene, const RingInput& ring) {
  return fem::solid_reason(ring_structure(ring), face_features(scene, sun_and_planets(scene).planet, "planet", ring,
                                                               "ring", planetary(scene).errors.ring_planet_misalignment,
                                                               gauges_need_solid(scene, ring)));
}

std::string solid_reason(const Scene& scene) {
  return fem::solid_reason({}, face_features(scene, sun_and_planets(scene).planet, "planet", sun_and_planets(scene).sun,
                                             "sun", planetary(scene).errors.sun_planet_misalignment));
}

namespace {

/// `partner`: the other mesh of the planets.
std::optional<fem::PlanetRollers> rollers_of(const Scene& scene, const geometry::GearPair& partner) {
  if (sun_and_planets(scene).planet.bore != BoreOn::rollers) return std::nullopt;
  return fem::PlanetRollers{planetary(scene).supports.planet, planetary(scene).supports.planet_clearance / 2, partner};
}

/// Load moves along the face of gears that tilt.
std::string why_it_tilts(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  if (!moves_in_space(scene)) return {};
  const auto reasons = spatial_frame(scene, geometry, ring).reasons_for_space();
  return reasons.empty() ? "" : "the gears tilt: " + reasons.front();
}

}  // namespace

MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry) {
  return mesh_model(scene, {.mesh = sun_planet,
                            .title = "sun-planet mesh",
                            .pair = geometry.sun_mesh(),
                            .input = sun_and_planets(scene).sun_planet,
                            .pinion = sun_and_planets(scene).planet,
                            .wheel = sun_and_planets(scene).sun,
                            .pinion_name = "planet",
                            .wheel_name = "sun",
                            .wheel_support_diameter = sun_and_planets(scene).sun.bore_diameter,
                            .planet_rollers = rollers_of(scene, geometry.rings.front().set.ring_mesh()),
                            .misalignment = planetary(scene).errors.sun_planet_misalignment,
                            .mean_force = geometry.operating_point.mean_mesh_force,
                            .why_it_tilts = why_it_tilts(scene, geometry, 0)});
}

namespace {

GearMesh ring_gear_mesh(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& input = planetary(scene).rings.at(ring);
  const auto& made = geometry.rings.at(ring);
  return {.mesh = ring_planet,
          .title = "ring-planet mesh",
          .variant = input.name,
          .pair = made.set.ring_mesh(),
          .input = planetary(scene).ring_planet,
          .pinion = sun_and_planets(scene).planet,
          .wheel = input,
          .pinion_name = "planet",
          .wheel_name = "ring",
          .wheel_support_diameter = 2 * made.outside_radius,
          .structure = ring_structure(input),
          .gauges = gauges_on(scene, input, made.set.ring_mesh().common_face().width),
          .gauges_across = gauges_need_solid(scene, input),
          .planet_rollers = rollers_of(scene, made.set.sun_mesh()),
          .misalignment = planetary(scene).errors.ring_planet_misalignment,
          .mean_force = geometry.operating_point.mean_mesh_force,
          .ring_modes_count = scene.dynamics && planetary(scene).rim_coupling == RimCoupling::elastic,
          .why_it_tilts = why_it_tilts(scene, geometry, ring)};
}

}  // namespace

MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  return mesh_model(scene, ring_gear_mesh(scene, geometry, ring));
}

std::optional<fem::LoadedMeshProblem> ring_mesh_problem(const Scene& scene, const GearGeometry& geometry,
                                                        std::size_t ring) {
  return mesh_problem(scene, ring_gear_mesh(scene, geometry, ring));
}

std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry) {
  std::vector<MeshModel> models = {sun_mesh_model(scene, geometry)};
  for (std::size_t i = 0; i < planetary(scene).rings.size(); ++i) models.push_back(ring_mesh_model(scene, geometry, i));
  return models;
}

namespace {

StartSpread spread_of(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& simulation, int count,
                      int seed) {
  const auto spread = dynamics::initial_spread(
      stage, {.random_starts = count - 1, .seed = static_cast<std::uint64_t>(seed), .simulation = simulation});
  const auto& specs = stage_study_figures();
  return {.starts = count,
          .motions = spread.attractors,
          .low = {specs, spread.low},
          .high = {specs, spread.high},
          .not_steady = spread.unsteady};
}

}  // namespace

FigureSet stage_losses(const Scene& scene, const GearGeometry& geometry, std::size_t ring, const MeshResult& sun_mesh,
                       const MeshResult& ring_mesh) {
  FigureSet figures;
  if (!has_friction(scene)) return figures;
  const auto& set = geometry.rings.at(ring).set;
  const auto& point = geometry.operating_point;
  const auto losses = [&](const MeshResult& mesh, const char* name, const geometry::GearPair& pair) {
    return mesh_losses(scene, name, {&pair, point.mesh_frequency, point.mean_mesh_force}, mesh.shares,
                       scene.stage.planets);
  };
  dynamics::add_losses(figures,
                       {losses(sun_mesh, sun_planet, set.sun_mesh()), losses(ring_mesh, ring_planet, set.ring_mesh())},
                       point.driving_power());
  return figures;
}

const std::vector<FigureSpec>& stage_study_figures() {
  static const auto list = [] {
    auto specs = dynamics::planetary_figures();
    specs.push_back(dynamics::efficiency_figure());
    return specs;
  }();
  return list;
}

std::unique_ptr<LumpedModel> planetary_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  const auto stage = make_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  const auto simulation = simulation_options(scene, stage);
  const auto efficiency = dynamics::efficiency_alone(stage_losses(scene, geometry, ring, sun_mesh, ring_mesh));
  return std::make_unique<LumpedModel>(
      identity_of(response_id(stage, simulation, sun_mesh, ring_mesh), std::string(dynamics::point_method())),
      [stage, simulation, efficiency](Answer wanted) -> StudyPoint {
        auto point = dynamics::evaluate_point(stage, {.simulation = simulation, .motion = wanted == Answer::all});
        point.figures.add(efficiency);
        return {.figures = {stage_study_figures(), point.figures}, .poincare = std::move(point.poincare)};
      },
      LumpedModel::Abilities{
          [stage, simulation](int count, int seed) { return spread_of(stage, simulation, count, seed); },
          [stage, simulation, efficiency](const dynamics::SystemState* start) -> LumpedModel::FollowedPoint {
            auto point = dynamics::evaluate_point(
                stage, {.simulation = dynamics::followed_from(simulation, start), .motion = true});
            point.figures.add(efficiency);
            return {{.figures = {stage_study_figures(), point.figures}, .poincare = std::move(point.poincare)},
                    std::move(point.end)};
          },
          [stage] { return dynamics::lumped_case(stage); },
          [stage](const dynamics::TimeSeries& series) { return dynamics::space_motion(stage, series); }});
}

}  // namespace annulus::app
