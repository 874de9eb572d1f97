#include "app/scene/model_limits.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/sector_mesh.h"

namespace annulus::app {

namespace {

/// Stiffness of a mesh per unit of face width, in Young's moduli: 20 N/(mm um) for steel, the usual mean [ISO6336-1].
constexpr double usual_mesh_stiffness = 0.1;

constexpr const char* no_engagement = "beyond that the teeth hardly engage";

}  // namespace

double displacement_limit(const Scene& scene) { return largest_gear_displacement * scene.stage.module; }

std::string length_mm(double length) { return to_text(length / units::mm, 7) + " mm"; }

double least_rim(const Scene& scene) { return geometry::min_circle_distance * scene.stage.module; }

std::string rim_rule(const Scene& scene) {
  return fmt::format("a computed mesh needs {} = {} modules of rim behind the root", length_mm(least_rim(scene)),
                     geometry::min_circle_distance);
}

void check_bore(const Scene& scene, const char* table, const HubGearInput& input, const geometry::Gear& gear) {
  if (!input.bore_diameter) return;
  const double most = 2 * (gear.root_radius() - least_rim(scene));
  if (*input.bore_diameter <= most * (1 + diameter_rounding)) return;
  throw GeometryError(fmt::format("{}.bore_diameter_mm = {}: must be in range: 0 < value <= {}; {}", table,
                                  to_text(*input.bore_diameter / units::mm), length_mm(most), rim_rule(scene)));
}

std::string small_displacements_rule() {
  return fmt::format("the model is for small displacements and strains, up to {} modules", largest_deflection);
}

void check_load(const Scene& scene, const char* key, double force, double face_width, double youngs_modulus) {
  const double in_modules = force / (usual_mesh_stiffness * youngs_modulus * face_width) / scene.stage.module;
  if (in_modules <= largest_deflection) return;
  throw InputError(
      fmt::format("{}: each mesh carries {} N. Teeth of this module, width and material then deflect by about {:.2g} "
                  "modules; {}. Reduce the load {:.3g} times, or make the teeth stiffer",
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
      fmt::format("{} = {}: turns by more than {} rad under the load, but the model is for small rotations; must be at "
                  "least {} N/m",
                  key, to_text(stiffness, 6), largest, to_text(force / (largest * radius), 3)));
}

void check_deviations(const Scene& scene) {
  const double limit = displacement_limit(scene) / units::um;
  const auto check = [&](const std::string& key, double value) {
    if (std::abs(value) <= limit) return;
    const std::string text = to_text(limit, 6);
    throw InputError(fmt::format("{} = {}: must be in range: -{} <= value <= {} µm, {} of the module: {}", key,
                                 to_text(value), text, text, largest_gear_displacement, no_engagement));
  };
  for (const auto& input : scene.inputs) {
    const bool deviation =
        (input.key.starts_with("errors.") || input.key.starts_with("tolerances.")) && input.key.ends_with("_um");
    if (!deviation || input.key.ends_with("_misalignment_um")) continue;
    if (const auto* value = std::get_if<double>(&input.value)) check(input.key, *value);
    if (const auto* list = std::get_if<std::vector<double>>(&input.value))
      for (const double value : *list) check(input.key, value);
  }
}

}  // namespace annulus::app
