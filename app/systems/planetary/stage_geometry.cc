#include "app/systems/planetary/stage_geometry.h"

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/units.h"

namespace annulus::app {

double outside_radius(const Scene& scene, const RingInput& ring) {
  if (ring.outside_diameter) return *ring.outside_diameter / 2;
  return make_gear(scene, ring, geometry::GearKind::internal).root_radius() + ring.rim_thickness.value_or(0);
}

std::optional<double> known_outside(const Scene& scene, const RingInput& ring) {
  if (!ring.outside_diameter && !ring.rim_thickness) return std::nullopt;
  try {
    return outside_radius(scene, ring);
  } catch (const GeometryError&) {
    return std::nullopt;
  }
}

GearGeometry make_geometry(const Scene& scene) {
  using geometry::GearKind;
  const auto sun =
      geometry_of("sun", [&] { return make_gear(scene, sun_and_planets(scene).sun, GearKind::external, -1); });
  const auto planet =
      geometry_of("planet", [&] { return make_gear(scene, sun_and_planets(scene).planet, GearKind::external); });
  GearGeometry result;
  for (const auto& input : planetary(scene).rings) {
    const std::string name = "ring '" + input.name + "'";
    const auto ring = geometry_of(name, [&] { return make_gear(scene, input, GearKind::internal); });
    const auto set = geometry_of(name, [&] {
      const auto& stage = scene.stage;
      const auto& angles = planetary(scene).stage.planet_angles;
      if (angles.empty()) return geometry::PlanetarySet(sun, planet, ring, stage.centre_distance, stage.planets);
      return geometry::PlanetarySet(sun, planet, ring, stage.centre_distance, angles);
    });
    const double outside = outside_radius(scene, input);
    if (outside <= ring.root_radius()) {
      throw GeometryError(name + ": outside diameter " + to_text(2e3 * outside, 7) +
                          " mm is not larger than the root diameter " + to_text(2e3 * ring.root_radius(), 7) +
                          " mm; make outside_diameter_mm larger");
    }
    result.rings.push_back({input.name, set, outside});
  }
  const auto& set = result.rings.front().set;
  result.operating_point = operating_point(planetary(scene).stage, scene.stage.planets, set.sun().teeth(),
                                           set.ring().teeth(), set.sun().base_radius());
  return result;
}

}  // namespace annulus::app
