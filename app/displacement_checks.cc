#include "app/displacement_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "app/mesh_model.h"
#include "app/two_k_v_model.h"
#include "core/errors.h"
#include "core/units.h"
#include "fem/problem_check.h"

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

bool computed(const MeshInput& mesh) {
  return mesh.stiffness == StiffnessShape::computed || mesh.stiffness == StiffnessShape::closed_form;
}

}  // namespace

void check_displacements(const Scene& scene, const GearGeometry& geometry) {
  if (scene.dynamics) check_errors(scene);
  if (computed(scene.sun_planet) || computed(scene.ring_planet))
    check_load(scene, "stage.power_kW", geometry.operating_point.mean_mesh_force);
  for (std::size_t i = 0; i < scene.rings.size(); ++i) check_supports(scene, geometry, i);
}

void check_displacements(const Scene& scene, const PairGeometry& geometry) {
  if (scene.dynamics) check_errors(scene);
  if (computed(scene.pinion_wheel)) check_load(scene, "stage.pinion_torque_Nm", geometry.transverse_force);
}

void check_sun_displacements(const Scene& scene) {
  if (computed(scene.sun_planet) || scene.sun_planet.compare == Compare::computed)
    check_load(scene, "output.torque_Nm", two_k_v_kinematics(scene).mean_sun_mesh_force());
}

}  // namespace annulus::app
