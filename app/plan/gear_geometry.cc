#include "app/plan/gear_geometry.h"

#include <algorithm>

namespace annulus::app {

double face_width_of(const Scene& scene, const GearInput& gear) {
  return gear.face_width.value_or(scene.stage.face_width);
}

double narrower_face(const Scene& scene, const GearInput& one, const GearInput& other) {
  return std::min(face_width_of(scene, one), face_width_of(scene, other));
}

geometry::GearParameters gear_parameters(const Scene& scene, const GearInput& input, geometry::GearKind kind,
                                         int hand) {
  return {.kind = kind,
          .teeth = input.teeth,
          .module = scene.stage.module,
          .pressure_angle = scene.stage.pressure_angle,
          .profile_shift = input.profile_shift,
          .face_width = face_width_of(scene, input),
          .tip_diameter = input.tip_diameter,
          .root_diameter = input.root_diameter,
          .root_fillet_factor = input.root_fillet_factor,
          .protuberance = input.protuberance,
          .protuberance_angle = input.protuberance_angle.value_or(scene.stage.pressure_angle / 2),
          .tip_chamfer = input.tip_chamfer,
          .tip_relief = input.tip_relief,
          .tip_relief_length = input.tip_relief_length,
          .profile_crowning = input.profile_crowning,
          .profile_slope = input.profile_slope,
          .lead_crowning = input.lead_crowning,
          .lead_slope = input.lead_slope,
          .helix_angle = hand * scene.stage.helix_angle,
          .axial_offset = input.axial_offset,
          .leading_topography = input.leading_flank,
          .trailing_topography = input.trailing_flank};
}

geometry::Gear make_gear(const Scene& scene, const GearInput& input, geometry::GearKind kind, int hand) {
  return geometry::Gear(gear_parameters(scene, input, kind, hand));
}

fem::Material material_of(const Scene& scene, const GearInput& gear) {
  const auto& common = scene.material;
  return {gear.youngs_modulus.value_or(common.youngs_modulus), gear.poisson_ratio.value_or(common.poisson_ratio),
          gear.density.value_or(common.density)};
}

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
  const auto sun = geometry_of("sun", [&] { return make_gear(scene, scene.sun, GearKind::external, -1); });
  const auto planet = geometry_of("planet", [&] { return make_gear(scene, scene.planet, GearKind::external); });
  GearGeometry result;
  for (const auto& input : scene.rings) {
    const std::string name = "ring '" + input.name + "'";
    const auto ring = geometry_of(name, [&] { return make_gear(scene, input, GearKind::internal); });
    const auto set = geometry_of(name, [&] {
      const auto& stage = scene.stage;
      if (stage.planet_angles.empty())
        return geometry::PlanetarySet(sun, planet, ring, stage.centre_distance, stage.planets);
      return geometry::PlanetarySet(sun, planet, ring, stage.centre_distance, stage.planet_angles);
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
  result.operating_point = operating_point(scene.stage, set.sun().teeth(), set.ring().teeth(), set.sun().base_radius());
  return result;
}

}  // namespace annulus::app
