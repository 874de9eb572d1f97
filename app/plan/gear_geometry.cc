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

}  // namespace annulus::app
