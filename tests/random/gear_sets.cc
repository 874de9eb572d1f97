#include "tests/random/gear_sets.h"
#include "core/units.h"

#include <cmath>
#include <numbers>

namespace annulus::random {

double Rack::transverse_module_mm() const { return module_mm / std::cos(helix_angle_deg * units::deg); }
double Rack::transverse_pressure_angle() const {
  return std::atan(std::tan(pressure_angle_deg * units::deg) / std::cos(helix_angle_deg * units::deg));
}

double Rack::least_profile_shift(long teeth) const {
  constexpr double dedendum = 1.25, least_fillet = 0.34;
  const double section = std::sin(transverse_pressure_angle());
  return dedendum - least_fillet * (1 - std::sin(pressure_angle_deg * units::deg)) -
         static_cast<double>(teeth) / std::cos(helix_angle_deg * units::deg) * section * section / 2 + 0.02;
}

void flank_keys(GearSet& set, const std::string& gear, Section section) {
  set.together.emplace_back(gear + ".tip_relief_um", gear + ".tip_relief_length_mm");
  set.chances[gear + ".tip_chamfer_mm"] = set.chances[gear + ".protuberance_um"] = 0.1;
  if (section != Section::solid) set.chances[gear + ".lead_crowning_um"] = set.chances[gear + ".lead_slope_um"] = 0;
}

void material_keys(Draw& draw, GearSet& set, const std::string& gear, const Rack& rack) {
  set.values[gear + ".youngs_modulus_GPa"] = rounded(rack.youngs_modulus_GPa * draw.log_uniform(0.2, 2));
  set.values[gear + ".poisson_ratio"] = draw.one_of<double>({0.2, 0.3, 0.38});
  set.values[gear + ".density_kg_per_m3"] = rounded(draw.log_uniform(1000, 9000));
  for (const auto* key : {".youngs_modulus_GPa", ".poisson_ratio", ".density_kg_per_m3"}) set.chances[gear + key] = 0.1;
}

void face_keys(Draw& draw, GearSet& set, const std::string& gear, const Rack& rack) {
  set.values[gear + ".face_width_mm"] = rounded(rack.face_width_mm * draw.uniform(0.9, 1.2));
  set.values[gear + ".axial_offset_mm"] = rounded(rack.face_width_mm * draw.uniform(-0.02, 0.02));
  set.chances[gear + ".face_width_mm"] = 0.2;
  // Helical planetary sets need all middles in one plane.
  set.chances[gear + ".axial_offset_mm"] = rack.helix_angle_deg == 0 ? 0.1 : 0;
}

void mesh_keys(GearSet& set, const std::string& mesh, Section section) {
  if (section != Section::solid) set.chances["errors." + mesh + "_misalignment_um"] = 0;
}

Rack draw_rack(Draw& draw, Section section, SceneDraft& draft) {
  Rack rack;
  rack.module_mm = rounded(draw.log_uniform(0.4, 20), 3);
  rack.pressure_angle_deg = draw.one_of<double>({17.5, 20, 20, 20, 22.5, 25});
  rack.face_width_mm = rounded(rack.module_mm * draw.uniform(6, 18));
  if (section == Section::solid && draw.chance(0.5)) rack.helix_angle_deg = rounded(draw.uniform(-18, 18), 3);
  rack.youngs_modulus_GPa = draw.one_of<double>({206, 206, 206, 110, 70, 2.8});
  draft.set("stage.module_mm", rack.module_mm);
  draft.set("stage.pressure_angle_deg", rack.pressure_angle_deg);
  draft.set("stage.face_width_mm", rack.face_width_mm);
  if (rack.helix_angle_deg != 0) draft.set("stage.helix_angle_deg", rack.helix_angle_deg);
  draft.set("material.youngs_modulus_GPa", rack.youngs_modulus_GPa);
  if (draw.chance(0.3)) draft.set("material.poisson_ratio", draw.one_of<double>({0.0, 0.25, 0.3, 0.4}));
  return rack;
}

Disc draw_disc(Draw& draw, double diameter_mm, double width_mm) {
  constexpr double steel = 7850;
  const double radius = diameter_mm * 1e-3 / 2;
  Disc disc;
  disc.mass = rounded(draw.uniform(0.7, 1.5) * steel * std::numbers::pi * radius * radius * width_mm * 1e-3);
  disc.inertia = rounded(disc.mass * radius * radius * draw.uniform(0.4, 0.7));
  return disc;
}

}  // namespace annulus::random
