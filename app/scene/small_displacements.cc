#include "app/scene/small_displacements.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// Displacement of a gear from its nominal position, in modules: flanks overlap by two modules, and half of one reduces
/// the contact ratio to one.
constexpr double largest_gear_displacement = 0.5;
/// Stiffness of a mesh per unit of face width, in Young's moduli: 20 N/(mm um) for steel, the usual mean (ISO 6336-1).
constexpr double usual_mesh_stiffness = 0.1;

constexpr const char* no_engagement = "beyond that the teeth hardly engage";

double displacement_limit(const Scene& scene) { return largest_gear_displacement * scene.stage.module; }

}  // namespace

std::string small_displacements_rule() {
  return fmt::format("small displacements and strains are computed, up to {} modules", largest_deflection);
}

void check_load(const Scene& scene, const char* key, double force) {
  const double in_modules =
      force / (usual_mesh_stiffness * scene.material.youngs_modulus * scene.stage.face_width) / scene.stage.module;
  if (in_modules <= largest_deflection) return;
  throw InputError(
      fmt::format("{}: each mesh carries {} N, under which teeth of this module, width and material deflect by some "
                  "{:.2g} modules; {}: reduce the load {:.3g} times, or make the teeth stiffer",
                  key, to_text(force, 4), in_modules, small_displacements_rule(), in_modules / largest_deflection));
}

void check_prescribed_mesh(const Scene& scene, const char* key, const MeshInput& mesh, double force) {
  if (!mesh.mean || force <= displacement_limit(scene) * *mesh.mean) return;
  throw InputError(fmt::format(
      "{}: a mesh of {} N/m deflects by {} mm under its load of {} N; at most {} of the module is possible: "
      "{}; reduce the load {:.3g} times",
      key, to_text(*mesh.mean, 4), to_text(force / *mesh.mean / units::mm, 3), to_text(force, 3),
      largest_gear_displacement, no_engagement, force / (displacement_limit(scene) * *mesh.mean)));
}

void check_bearing(const Scene& scene, const char* key, double stiffness, double force) {
  if (stiffness == 0 || force <= displacement_limit(scene) * stiffness) return;
  throw InputError(
      fmt::format("{} = {}: deflects under the load of {} N by more than {} of the module: {}; must be at "
                  "least {} N/m",
                  key, to_text(stiffness, 6), to_text(force, 3), largest_gear_displacement, no_engagement,
                  to_text(force / displacement_limit(scene), 3)));
}

void check_torsional_support(const char* key, double stiffness, double force, double radius) {
  constexpr double largest = 0.1;  // rad
  if (force <= largest * radius * stiffness) return;
  throw InputError(
      fmt::format("{} = {}: turns by more than {} rad under the load, where small turns are computed; must be at least "
                  "{} N/m",
                  key, to_text(stiffness, 6), largest, to_text(force / (largest * radius), 3)));
}

void check_error(const Scene& scene, const char* key, double value) {
  if (std::abs(value) <= displacement_limit(scene)) return;
  const std::string limit = to_text(displacement_limit(scene) / units::um, 6);
  throw InputError(fmt::format("{} = {}: must be in range: -{} <= value <= {} µm, {} of the module: {}", key,
                               to_text(value / units::um), limit, limit, largest_gear_displacement, no_engagement));
}

bool has_elastic_bodies(const MeshInput& mesh) {
  return mesh.stiffness == StiffnessShape::computed || mesh.stiffness == StiffnessShape::closed_form;
}

}  // namespace annulus::app
