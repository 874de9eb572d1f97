#include "app/systems/helical_pair/pair_space.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/plan/gear_geometry.h"
#include "app/scene/input_place.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/shared/bearing_words.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/tilt_inertia.h"
#include "dynamics/spatial/even_face.h"
#include "dynamics/systems/helical_pair/spatial_pair.h"

namespace annulus::app {

namespace {

using Body = dynamics::StageBody::Kind;

/// The pair without its face and its stiffness.
dynamics::SpatialPair spatial_pair(const Scene& scene, const PairGeometry& geometry) {
  const auto& space = scene.own<SpaceInput>();
  const double angle = geometry.gears.working_pressure_angle();
  dynamics::SpatialPair pair;
  pair.base_helix_angle = std::copysign(geometry.base_helix_angle, scene.stage.helix_angle);
  pair.working_angle = angle;
  pair.working_radius_pinion = geometry.pinion().base_radius() / std::cos(angle);
  pair.working_radius_wheel = geometry.wheel().base_radius() / std::cos(angle);
  pair.pinion_torque = helical_pair(scene).stage.pinion_torque;
  for (const auto& input : space.bearings) pair.bearings.push_back(stage_bearing(input, {input.body}, input.name));
  // A gear without bearings has those of its table in the middle; it tilts only where others hold it.
  for (const auto& [body, gear] :
       {std::pair{Body::pinion, &helical_pair(scene).pinion}, {Body::wheel, &helical_pair(scene).wheel}}) {
    if (space.has_radial_bearing(body)) continue;
    const bool any = space.has_bearing(body);
    dynamics::StageBearing support;
    support.name = "support";
    support.body = {body};
    support.x = support.y = gear->bearing_transverse;
    support.axial = any ? 0 : gear->bearing_axial;
    support.tilt = any ? 0 : rigid;
    pair.bearings.push_back(std::move(support));
  }
  for (const auto& input : space.loads) pair.loads.push_back(stage_load(input, {input.body}, input.name));
  if (space.gravity) {
    pair.gravity = space.gravity->vector();
    pair.weights = {{{Body::pinion}, *helical_pair(scene).pinion.mass, space.gravity->pinion},
                    {{Body::wheel}, *helical_pair(scene).wheel.mass, space.gravity->wheel}};
  }
  return pair;
}

/// Before its mesh is solved.
dynamics::SpatialPair unsolved_pair(const Scene& scene, const PairGeometry& geometry) {
  auto pair = spatial_pair(scene, geometry);
  pair.face = motion_face(geometry.gears, helical_pair(scene).pinion_wheel, nullptr,
                          helical_pair(scene).errors.pinion_wheel_misalignment, GapsAlong::normal);
  return pair;
}

}  // namespace

bool pair_in_space(const Scene& scene) { return scene.own<SpaceInput>().any(); }

void check_pair_bearings(const Scene& scene, const PairGeometry& geometry) {
  if (!pair_in_space(scene)) return;
  auto pair = unsolved_pair(scene, geometry);
  pair.stiffness = nominal_mesh_stiffness(geometry.gears);
  about(scene, "bearing", [&] { check_held(pair); });
}

std::string why_gears_tilt(const Scene& scene, const PairGeometry& geometry) {
  if (!pair_in_space(scene)) return {};
  const auto reasons = unsolved_pair(scene, geometry).reasons_for_space();
  return reasons.empty() ? "" : "the gears tilt: " + reasons.front();
}

void put_in_space(dynamics::HelicalPair& pair, const Scene& scene, const PairGeometry& geometry,
                  const std::shared_ptr<const FaceShape>& face) {
  const auto& tilting = scene.own<SpaceInput>().tilt_inertia;
  const auto gravity = scene.own<SpaceInput>().gravity.value_or(GravityInput{});
  const auto tilting_of = [&](const char* name, const std::optional<double>& given, const PairGearInput& gear,
                              double centre) {
    return tilt_inertia(scene,
                        {name, given, *gear.mass, *pair_inertia(scene, gear), face_width_of(scene, gear), centre});
  };
  const double of_pinion = tilting_of("pinion", tilting.pinion, helical_pair(scene).pinion, gravity.pinion);
  const double of_wheel = tilting_of("wheel", tilting.wheel, helical_pair(scene).wheel, gravity.wheel);
  auto spatial = spatial_pair(scene, geometry);
  spatial.stiffness = dynamics::mean_stiffness(pair.mesh);
  spatial.face = motion_face(geometry.gears, helical_pair(scene).pinion_wheel, face,
                             helical_pair(scene).errors.pinion_wheel_misalignment, GapsAlong::normal);
  about(scene, "bearing", [&] { pair.space = dynamics::pair_about_equilibrium(spatial, of_pinion, of_wheel); });
  pair.space->laws = scene.own<SpaceInput>().bearing_laws;
  pair.space->mass_place_pinion = gravity.pinion;
  pair.space->mass_place_wheel = gravity.wheel;
}

MovingFaces moving_pair_face(const Scene& scene, const PairGeometry& geometry, const dynamics::HelicalPair& pair,
                             const MeshResult& mesh, const RunOptions& options) {
  if (mesh.face) {
    const auto solid = solid_face(mesh, options);
    const double force = geometry.transverse_force / std::cos(geometry.base_helix_angle);
    return {[=](std::size_t, double cycles) { return solid->at(cycles, force); }};
  }
  const auto even = even_stations(geometry.gears, helical_pair(scene).pinion_wheel,
                                  helical_pair(scene).errors.pinion_wheel_misalignment);
  const auto law = std::make_shared<const dynamics::EvenFace>(dynamics::mean_stiffness(pair.mesh), even.at, even.gap);
  return {[law](std::size_t, double) { return law; }};
}

std::vector<DofPlan> pair_dofs_in_space(const Scene& scene, const PairGeometry& geometry, std::vector<DofPlan> plane) {
  if (!pair_in_space(scene)) return plane;
  const auto pair = unsolved_pair(scene, geometry);
  const bool leaves_plane = !pair.reasons_for_space().empty();
  std::vector<DofPlan> list;
  for (const auto& [body, name] : {std::pair{Body::pinion, std::string("pinion")}, {Body::wheel, "wheel"}}) {
    std::vector<dynamics::StageBearing> bearings;
    for (const auto& b : pair.bearings)
      if (b.body.kind == body) bearings.push_back(b);
    list.push_back(radial_dof(name, bearings));
    if (leaves_plane) {
      list.push_back(axial_dof(name, bearings));
      list.push_back(tilt_dof(name, bearings));
    } else {
      list.push_back(no_dof_out_of_plane(name));
    }
    for (const auto& dof : plane)
      if (dof.name == name + " u") list.push_back(dof);
  }
  return list;
}

std::vector<Warning> pair_space_warnings(const Scene& scene) {
  std::vector<Warning> list;
  if (!pair_in_space(scene)) return list;
  const auto& space = scene.own<SpaceInput>();
  std::vector<std::string> held, assumed;
  for (const auto& [body, name, gear, tilting] :
       {std::tuple{Body::pinion, "pinion", &helical_pair(scene).pinion, &space.tilt_inertia.pinion},
        {Body::wheel, "wheel", &helical_pair(scene).wheel, &space.tilt_inertia.wheel}}) {
    if (!space.has_bearing(body)) held.emplace_back(name);
    if (!*tilting) assumed.push_back(fmt::format("tilt_inertia.{}_kg_m2", name));
    const auto key = fmt::format("{}.bearing_transverse_N_per_m", name);
    const auto* input = scene.find(key);
    if (input != nullptr && input->origin == Origin::scene && space.has_radial_bearing(body))
      list.push_back({"support_replaced", Severity::warning,
                      fmt::format("{} is left out: the {} is held by its [[bearing]] tables alone", key, name)});
  }
  if (!held.empty())
    list.push_back({"held_in_space", Severity::warning,
                    fmt::format("no [[bearing]] holds the {}: it lies in the bearings of its own table and is assumed "
                                "not to tilt",
                                fmt::join(held, ", "))});
  if (!assumed.empty()) list.push_back(tilt_inertia_assumed(assumed));
  return list;
}

}  // namespace annulus::app
