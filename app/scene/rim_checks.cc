#include "app/scene/rim_checks.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/sector_mesh.h"

namespace annulus::app {

namespace {

/// Rounding of diameters that come from sums.
constexpr double rounding = 1e-9;

std::string mm(double length) { return to_text(length / units::mm, 7) + " mm"; }

/// Least thickness of a rim, m.
double least_rim(const Scene& scene) { return geometry::min_circle_distance * scene.stage.module; }

std::string why(const Scene& scene) {
  return fmt::format("a computed mesh needs {} = {} modules of rim behind the root", mm(least_rim(scene)),
                     geometry::min_circle_distance);
}

void check_bore(const Scene& scene, const char* table, const HubGearInput& input, const geometry::Gear& gear) {
  if (!input.bore_diameter) return;
  const double most = 2 * (gear.root_radius() - least_rim(scene));
  if (*input.bore_diameter <= most * (1 + rounding)) return;
  throw GeometryError(fmt::format("{}.bore_diameter_mm = {}: must be in range: 0 < value <= {}; {}", table,
                                  to_text(*input.bore_diameter / units::mm), mm(most), why(scene)));
}

void check_ring(const Scene& scene, const RingInput& input, const RingGeometry& ring) {
  const auto refuse = [&](const char* key, double value, const std::string& rule) {
    throw GeometryError(fmt::format("ring '{}': {} = {}: {}", input.name, key, to_text(value / units::mm), rule));
  };
  const double root = ring.set.ring().root_radius(), rim = ring.outside_radius - root, least = least_rim(scene);
  if (rim < least * (1 - rounding)) {
    if (input.rim_thickness)
      refuse("rim_thickness_mm", *input.rim_thickness, fmt::format("must be at least {}; {}", mm(least), why(scene)));
    refuse("outside_diameter_mm", 2 * ring.outside_radius,
           fmt::format("must be at least {}; {}", mm(2 * (root + least)), why(scene)));
  }
  if (input.sleeve_thickness && *input.sleeve_thickness > (rim - least) * (1 + rounding))
    refuse(
        "sleeve_thickness_mm", *input.sleeve_thickness,
        fmt::format("must be in range: 0 < value <= {}: the sleeve lies in the rim, which is {} thick, and keeps {} = "
                    "{} modules from the root",
                    mm(rim - least), mm(rim), mm(least), geometry::min_circle_distance));
  const double smallest = 2 * (root + least), largest = 2 * (ring.outside_radius - least);
  if (input.clamp_inner_diameter && (*input.clamp_inner_diameter < smallest * (1 - rounding) ||
                                     *input.clamp_inner_diameter > largest * (1 + rounding)))
    refuse(
        "clamp_inner_diameter_mm", *input.clamp_inner_diameter,
        fmt::format("must be in range: {} <= value <= {}: the clamped end faces lie in the rim, and their edge keeps "
                    "{} = {} modules from root and outside",
                    mm(smallest), mm(largest), mm(least), geometry::min_circle_distance));
}

}  // namespace

void check_rims(const Scene& scene, const GearGeometry& geometry) {
  const bool sun = scene.sun_planet.stiffness == StiffnessShape::computed;
  const bool ring = scene.ring_planet.stiffness == StiffnessShape::computed;
  if (sun) check_bore(scene, "sun", scene.sun, geometry.sun_mesh().wheel());
  if (sun || ring) check_bore(scene, "planet", scene.planet, geometry.sun_mesh().planet());
  if (!ring) return;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) check_ring(scene, scene.rings[i], geometry.rings.at(i));
}

void check_rims(const Scene& scene, const PairGeometry& geometry) {
  const auto shape = scene.pinion_wheel.stiffness;
  if (shape != StiffnessShape::computed && shape != StiffnessShape::closed_form) return;
  check_bore(scene, "pinion", scene.pinion, geometry.pinion());
  check_bore(scene, "wheel", scene.wheel, geometry.wheel());
}

void check_rims(const Scene& scene, const geometry::GearPair& pair) {
  if (scene.sun_planet.stiffness != StiffnessShape::computed && scene.sun_planet.compare != Compare::computed) return;
  check_bore(scene, "sun", scene.sun, pair.wheel());
  check_bore(scene, "planet", scene.planet, pair.planet());
}

}  // namespace annulus::app
