#include "app/systems/two_k_v/two_k_v_model.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/model/excitation.h"
#include "app/model/stiff_supports.h"
#include "app/results/cached_value.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_members.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

bool is_computed(const MeshInput& input) { return input.stiffness == StiffnessShape::computed; }

/// No backlash leaves nothing to part: the mesh is then linear, with forces of either sign.
std::optional<double> half_backlash(const MeshInput& mesh, const DynamicsInput& dynamics) {
  const double half = mesh.half_backlash.value_or(dynamics.half_backlash);
  if (half == 0) return std::nullopt;
  return half;
}

}  // namespace

geometry::GearPair sun_planet_pair(const Scene& scene) {
  using geometry::GearKind;
  const auto sun = geometry_of("sun", [&] { return make_gear(scene, sun_and_planets(scene).sun, GearKind::external); });
  const auto planet =
      geometry_of("planet", [&] { return make_gear(scene, sun_and_planets(scene).planet, GearKind::external); });
  const double distance =
      scene.stage.module * (sun_and_planets(scene).sun.teeth + sun_and_planets(scene).planet.teeth) / 2;
  const double apart = 2 * distance * std::sin(std::numbers::pi / scene.stage.planets);
  if (scene.stage.planets > 1 && apart <= 2 * planet.tip_radius())
    throw InputError(fmt::format(
        "stage.planets = {}: neighbouring planets interfere: their centres are {} mm apart, their tip diameter "
        "is {} mm; take fewer",
        scene.stage.planets, to_text(apart / units::mm, 5), to_text(2e3 * planet.tip_radius(), 5)));
  return geometry_of("sun and planet", [&] { return geometry::GearPair(planet, sun, distance); });
}

void check_two_k_v(const Scene& scene) {
  (void)sun_planet_pair(scene);
  if (const auto arc = arc_tooth_mesh(scene)) arc->check();
  const auto other = compared_scene(scene);
  (void)arc_pins_result(other ? *other : scene);  // load within the range of the contact formula
}

dynamics::TwoKVStage two_k_v_kinematics(const Scene& scene) {
  dynamics::TwoKVStage stage;
  stage.sun_teeth = sun_and_planets(scene).sun.teeth;
  stage.planet_teeth = sun_and_planets(scene).planet.teeth;
  stage.pins = two_k_v(scene).arc_gear.pins;
  stage.arc_teeth = two_k_v(scene).arc_gear.pins - 1;
  stage.cranks = scene.stage.planets;
  stage.arc_gears = two_k_v(scene).arc_gear.count;
  stage.module = scene.stage.module;
  stage.pressure_angle = scene.stage.pressure_angle;
  stage.eccentricity = two_k_v(scene).arc_gear.eccentricity;
  stage.crank_angle = two_k_v(scene).crank.angle;
  stage.output_speed = two_k_v(scene).output.speed;
  stage.output_torque = two_k_v(scene).output.torque;
  return stage;
}

std::optional<dynamics::ArcToothMesh> arc_tooth_mesh(const Scene& scene) {
  const auto& a = two_k_v(scene).arc_gear;
  if (!a.pin_circle_diameter || !a.pin_diameter || !a.arc_radius || !a.width) return std::nullopt;
  return dynamics::ArcToothMesh{.pins = a.pins,
                                .eccentricity = a.eccentricity,
                                .pin_circle_radius = *a.pin_circle_diameter / 2,
                                .pin_radius = *a.pin_diameter / 2,
                                .arc_radius = *a.arc_radius,
                                .width = *a.width,
                                .youngs_modulus = scene.material.youngs_modulus,
                                .poisson_ratio = scene.material.poisson_ratio,
                                .clearance = a.clearance,
                                .approach = a.approach};
}

std::optional<Scene> compared_scene(const Scene& scene) {
  Scene changed = scene;
  bool any = false;
  auto& own = two_k_v(changed);
  for (const auto& [mesh, compare] : {std::pair{&sun_and_planets(changed).sun_planet, own.compare_sun_planet},
                                      {&own.arc_pins, own.compare_arc_pins}}) {
    if (compare != Compare::computed || is_computed(*mesh)) continue;
    mesh->stiffness = StiffnessShape::computed;
    any = true;
  }
  return any ? std::optional(std::move(changed)) : std::nullopt;
}

MeshModel two_k_v_sun_model(const Scene& scene) {
  const auto pair = sun_planet_pair(scene);
  return mesh_model(scene, {.mesh = sun_planet,
                            .title = "sun-planet mesh",
                            .pair = pair,
                            .input = sun_and_planets(scene).sun_planet,
                            .pinion = sun_and_planets(scene).planet,
                            .wheel = sun_and_planets(scene).sun,
                            .pinion_name = "planet",
                            .wheel_name = "sun",
                            .wheel_support_diameter = sun_and_planets(scene).sun.bore_diameter,
                            .mean_force = two_k_v_kinematics(scene).mean_sun_mesh_force()});
}

MeshModel arc_pins_model(const Scene& scene) {
  MeshModel model;
  model.mesh = arc_pins;
  model.title = "mesh of arc teeth and pins";
  if (is_computed(two_k_v(scene).arc_pins)) {
    model.fidelity = "line_contact";
    model.reason = "line contact of pins and concave arcs, shared by all pins on the loaded side";
    model.repeats = "equal teeth on equal pins: one mesh cycle is enough";
  } else {
    model.fidelity = "prescribed";
    model.reason = "the scene prescribes the stiffness (mesh.arc_pins)";
    model.repeats = "as prescribed";
  }
  return model;
}

MeshResult prescribed_sun_result(const Scene& scene, const MeshModel& model) {
  return prescribed_stiffness(model, sun_and_planets(scene).sun_planet, scene, sun_planet_pair(scene).contact_ratio(),
                              two_k_v_kinematics(scene).mean_sun_mesh_force());
}

MeshResult arc_pins_result(const Scene& scene) {
  const auto stage = two_k_v_kinematics(scene);
  const auto model = arc_pins_model(scene);
  if (!is_computed(two_k_v(scene).arc_pins))
    return prescribed_stiffness(model, two_k_v(scene).arc_pins, scene, 0, stage.mean_arc_mesh_force());
  const auto mesh = arc_tooth_mesh(scene);
  require(mesh.has_value(), "a checked scene has the dimensions of its arc teeth");
  std::vector<double> torques;
  for (const double factor : fem::table_load_factors) torques.push_back(factor * stage.arc_torque());
  auto table = dynamics::arc_stiffness_table(*mesh, torques, fem::table_phases);
  double loaded = 0;
  for (int i = 0; i < fem::table_phases; ++i)
    loaded += dynamics::arc_position(*mesh, stage.arc_torque(), static_cast<double>(i) / fem::table_phases).loaded;
  table.provenance = {
      {"annulus_version", version()}, {"inputs_id", identity_of(*mesh, stage.arc_torque())}, {"model", model.fidelity}};
  return {.model = model,
          .contact_ratio = loaded / fem::table_phases,
          .table = std::move(table),
          .nominal = fem::nominal_load_index};
}

dynamics::TwoKVStage make_two_k_v(const Scene& scene, const TwoKVTables& tables, dynamics::LoadDependence dependence) {
  if (!scene.dynamics) throw InternalError("internal error: dynamics of a scene without [dynamics]");
  auto stage = two_k_v_kinematics(scene);
  stage.input_inertia = *two_k_v(scene).input.inertia;
  stage.sun_inertia = *sun_and_planets(scene).sun.inertia;
  stage.planet_inertia = *sun_and_planets(scene).planet.inertia;
  stage.planet_mass = *sun_and_planets(scene).planet.mass;
  stage.crank_inertia = *two_k_v(scene).crank.inertia;
  stage.arc_inertia = *two_k_v(scene).arc_gear.inertia;
  stage.arc_mass = *two_k_v(scene).arc_gear.mass;
  stage.output_inertia = *two_k_v(scene).output.inertia;
  stage.sun_mesh = excitation_of(sun_and_planets(scene).sun_planet, tables.sun, stage.mean_sun_mesh_force(), dependence,
                                 sun_planet_pair(scene).back_flank_phase());
  stage.arc_mesh = excitation_of(two_k_v(scene).arc_pins, tables.arc, stage.mean_arc_mesh_force(), dependence);
  const double sun = mean_stiffness(stage.sun_mesh), arcs = stage.arc_gears * mean_stiffness(stage.arc_mesh);
  const auto beside = [&](double neighbours, double stiffness) {
    return as_stiff_as_matters(stiffness, neighbours, scene.accuracy);
  };
  stage.input_shaft = beside(stage.cranks * sun * std::pow(stage.sun_base_radius(), 2), *two_k_v(scene).input.shaft);
  stage.crank_shaft = beside(sun * std::pow(stage.planet_base_radius(), 2) + arcs * std::pow(stage.eccentricity, 2),
                             *two_k_v(scene).crank.shaft);
  stage.crank_bearing = beside(sun + arcs, *two_k_v(scene).crank.bearing);
  stage.arc_bearing = beside(arcs, *two_k_v(scene).arc_gear.bearing);
  stage.input_support = two_k_v(scene).input.support;
  stage.output_support = two_k_v(scene).output.support;
  stage.sun_half_backlash = half_backlash(sun_and_planets(scene).sun_planet, *scene.dynamics);
  stage.arc_half_backlash = half_backlash(two_k_v(scene).arc_pins, *scene.dynamics);
  stage.damping_without_contact = scene.dynamics->mesh_damping == MeshDamping::always;
  stage.mesh_damping_ratio = scene.dynamics->mesh_damping_ratio;
  stage.support_damping_ratio = scene.dynamics->support_damping_ratio;
  stage.sun_mesh_damping_ratio = sun_and_planets(scene).sun_planet.damping_ratio;
  stage.arc_mesh_damping_ratio = two_k_v(scene).arc_pins.damping_ratio;
  stage.input_damping_ratio = two_k_v(scene).input.damping;
  stage.crank_shaft_damping_ratio = two_k_v(scene).crank.shaft_damping;
  stage.crank_bearing_damping_ratio = two_k_v(scene).crank.bearing_damping;
  stage.arc_bearing_damping_ratio = two_k_v(scene).arc_gear.bearing_damping;
  stage.output_damping_ratio = two_k_v(scene).output.damping;
  stage.structural_damping = structural_damping(*scene.dynamics);
  stage.rotors = rotors_of(scene);
  return stage;
}

dynamics::SimulationOptions two_k_v_simulation(const Scene& scene, const dynamics::TwoKVStage& stage) {
  return given_simulation(*scene.dynamics, stage.sun_mesh_frequency());
}

TwoKVModels two_k_v_models(const Scene& scene, const TwoKVTables& tables) {
  return {make_two_k_v(scene, tables, dynamics::LoadDependence::nominal),
          make_two_k_v(scene, tables, scene.dynamics->load_dependence), two_k_v(scene).arc_gear.clearance};
}

std::string two_k_v_id(const TwoKVModels& models, const dynamics::SimulationOptions& options,
                       const TwoKVTables& tables) {
  return identity_of(models, options, table_behind(models.moving.sun_mesh, tables.sun.table),
                     table_behind(models.moving.arc_mesh, tables.arc.table));
}

}  // namespace annulus::app
