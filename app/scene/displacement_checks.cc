#include "app/scene/displacement_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/plan/mesh_model.h"
#include "app/two_k_v/two_k_v_model.h"
#include "core/errors.h"
#include "core/units.h"
#include "fem/problem/problem_check.h"

namespace annulus::app {

namespace {

/// In modules, of what is known beforehand. Ten percent of a module are strains of some percent in the teeth.
constexpr double largest_deflection = 0.1;
/// Of a gear from its place, in modules: flanks overlap by two, and half of one brings the contact ratio down to one.
constexpr double largest_misplacement = 0.5;
/// Of a mesh per unit of face width, in Young's moduli: 20 N/(mm um) for steel, the usual mean (ISO 6336-1).
constexpr double mesh_stiffness = 0.1;

std::string small_displacements() {
  return fmt::format("small displacements and strains are computed, up to {} modules", largest_deflection);
}

/// `key` carries the load, which one mesh bears as `force` (N).
void check_load(const Scene& scene, const char* key, double force) {
  const double per_module =
      force / (mesh_stiffness * scene.material.youngs_modulus * scene.stage.face_width) / scene.stage.module;
  if (per_module <= largest_deflection) return;
  throw InputError(
      fmt::format("{}: each mesh carries {} N, under which teeth of this module, width and material give way by some "
                  "{:.2g} modules; {}: reduce the load {:.3g} times, or make the teeth stiffer",
                  key, to_text(force, 4), per_module, small_displacements(), per_module / largest_deflection));
}

void check_supports(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto model = ring_mesh_model(scene, geometry, ring);
  if (!model.computed() || !fem::on_single_supports(model.problem->structure)) return;
  const double turn = fem::turn_on_supports(*model.problem, geometry.operating_point.mean_mesh_force);
  const double modules = turn / scene.stage.module;
  if (modules <= largest_deflection) return;
  const auto& input = scene.rings.at(ring);
  throw InputError(
      fmt::format("ring '{}': turns on its {} by {} mm = {:.2g} modules under the nominal load; {}: make them stiffer, "
                  "more, or of less clearance",
                  input.name, input.has_pins() ? "pins or bolts" : "splines", to_text(turn / units::mm, 3), modules,
                  small_displacements()));
}

void check_error(const Scene& scene, const char* key, double value) {
  const double most = largest_misplacement * scene.stage.module;
  if (std::abs(value) <= most) return;
  throw InputError(
      fmt::format("{} = {}: must be in range: -{} <= value <= {} µm, {} of the module: beyond that the "
                  "teeth hardly reach into each other",
                  key, to_text(value / units::um), to_text(most / units::um, 6), to_text(most / units::um, 6),
                  largest_misplacement));
}

void check_errors(const Scene& scene) {
  const auto& e = scene.errors;
  for (const double x : e.planet_eccentricity) check_error(scene, "errors.planet_eccentricity_um", x);
  for (const double x : e.planet_installation) check_error(scene, "errors.planet_installation_um", x);
  check_error(scene, "errors.sun_eccentricity_um", e.sun_eccentricity);
  check_error(scene, "errors.sun_installation_um", e.sun_installation);
  check_error(scene, "errors.ring_eccentricity_um", e.ring_eccentricity);
  check_error(scene, "errors.ring_installation_um", e.ring_installation);
  check_error(scene, "errors.carrier_eccentricity_um", e.carrier_eccentricity);
  check_error(scene, "errors.carrier_installation_um", e.carrier_installation);
  check_error(scene, "errors.mesh_error_um", e.mesh_error.value_or(0));
  check_error(scene, "errors.pinion_error_um", e.pinion_error);
  check_error(scene, "errors.wheel_error_um", e.wheel_error);
}

/// `key` carries the load, which a mesh of given stiffness bears as `force` (N).
void check_given_mesh(const Scene& scene, const char* key, const MeshInput& mesh, double force) {
  const double most = largest_misplacement * scene.stage.module;
  if (!mesh.mean || force <= most * *mesh.mean) return;
  throw InputError(
      fmt::format("{}: a mesh of {} N/m closes by {} mm under its load of {} N, {} of the module are the most: beyond "
                  "that the teeth "
                  "hardly reach into each other; reduce the load {:.3g} times",
                  key, to_text(*mesh.mean, 4), to_text(force / *mesh.mean / units::mm, 3), to_text(force, 3),
                  largest_misplacement, force / (most * *mesh.mean)));
}

/// `key` (N/m) carries `force` (N) and lets a gear move along it.
void check_bearing(const Scene& scene, const char* key, double stiffness, double force) {
  const double most = largest_misplacement * scene.stage.module;
  if (stiffness == 0 || force <= most * stiffness) return;  // without a bearing the load is refused as unbalanced
  throw InputError(
      fmt::format("{} = {}: under the load of {} N it gives way by more than {} of the module: beyond that the teeth "
                  "hardly reach into each other; from {} N/m on it does not",
                  key, to_text(stiffness, 6), to_text(force, 3), largest_misplacement, to_text(force / most, 3)));
}

/// `key` is a torsional support with the stiffness `per_radius2` (N/m) at `radius` and carries `force` (N) there.
void check_turn(const char* key, double per_radius2, double force, double radius) {
  constexpr double most = 0.1;  // rad
  if (force <= most * radius * per_radius2) return;
  throw InputError(fmt::format(
      "{} = {}: turns by more than {} rad under the load; small turns are computed: from {} N/m on it does not", key,
      to_text(per_radius2, 6), most, to_text(force / (most * radius), 3)));
}

/// What the bearing of a central body has to carry at least, in mean mesh forces: planets on one side of it cannot hold
/// it in the middle. Forces that add up to one per planet, in directions fixed to the planets, are smallest together
/// when the outermost two share them.
double borne_by_bearing(const geometry::PlanetarySet& set) {
  double widest_gap = 2 * std::numbers::pi - set.planet_angle(set.planets() - 1);
  for (int n = 1; n < set.planets(); ++n)
    widest_gap = std::max(widest_gap, set.planet_angle(n) - set.planet_angle(n - 1));
  return set.planets() * std::max(0.0, -std::cos(widest_gap / 2));
}

void check_bearings(const Scene& scene, const GearGeometry& geometry) {
  const auto& s = scene.supports;
  const double mesh = geometry.operating_point.mean_mesh_force;
  check_bearing(scene, "supports.planet_N_per_m", s.planet, 2 * mesh);
  const double across = mesh * borne_by_bearing(geometry.rings.front().set);
  check_bearing(scene, "supports.sun_N_per_m", s.sun, across);
  check_bearing(scene, "supports.ring_N_per_m", s.ring, across);
  check_bearing(scene, "supports.carrier_N_per_m", s.carrier, 2 * across);
  const double all = scene.stage.planets * mesh;
  if (s.ring_torsional > 0)
    check_turn("supports.ring_torsional_N_per_m", s.ring_torsional, all,
               geometry.rings.front().set.ring().base_radius());
}

bool computed(const MeshInput& mesh) {
  return mesh.stiffness == StiffnessShape::computed || mesh.stiffness == StiffnessShape::closed_form;
}

}  // namespace

void check_displacements(const Scene& scene, const GearGeometry& geometry) {
  if (scene.dynamics) {
    check_errors(scene);
    check_bearings(scene, geometry);
    for (const auto* mesh : {&scene.sun_planet, &scene.ring_planet})
      check_given_mesh(scene, "stage.power_kW", *mesh, geometry.operating_point.mean_mesh_force);
  }
  if (computed(scene.sun_planet) || computed(scene.ring_planet))
    check_load(scene, "stage.power_kW", geometry.operating_point.mean_mesh_force);
  for (std::size_t i = 0; i < scene.rings.size(); ++i) check_supports(scene, geometry, i);
}

void check_displacements(const Scene& scene, const PairGeometry& geometry) {
  if (scene.dynamics) {
    check_errors(scene);
    const double across = geometry.transverse_force, along = across * std::tan(std::abs(scene.stage.helix_angle));
    check_given_mesh(scene, "stage.pinion_torque_Nm", scene.pinion_wheel, across);
    check_bearing(scene, "pinion.bearing_transverse_N_per_m", scene.pinion.bearing_transverse, across);
    check_bearing(scene, "wheel.bearing_transverse_N_per_m", scene.wheel.bearing_transverse, across);
    check_bearing(scene, "pinion.bearing_axial_N_per_m", scene.pinion.bearing_axial, along);
    check_bearing(scene, "wheel.bearing_axial_N_per_m", scene.wheel.bearing_axial, along);
  }
  if (computed(scene.pinion_wheel)) check_load(scene, "stage.pinion_torque_Nm", geometry.transverse_force);
}

void check_two_k_v_displacements(const Scene& scene) {
  const auto stage = two_k_v_kinematics(scene);
  if (scene.dynamics) {
    const double crank = std::abs(scene.output.torque) / (stage.cranks * stage.crank_circle_radius());
    check_given_mesh(scene, "output.torque_Nm", scene.sun_planet, std::abs(stage.mean_sun_mesh_force()));
    check_given_mesh(scene, "output.torque_Nm", scene.arc_pins, std::abs(stage.mean_arc_mesh_force()));
    check_bearing(scene, "crank.bearing_N_per_m", *scene.crank.bearing, crank);
    check_bearing(scene, "arc_gear.bearing_N_per_m", *scene.arc_gear.bearing, std::abs(stage.mean_arc_mesh_force()));
  }
  if (computed(scene.sun_planet) || scene.sun_planet.compare == Compare::computed)
    check_load(scene, "output.torque_Nm", stage.mean_sun_mesh_force());
}

}  // namespace annulus::app
