#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/random/gear_sets.h"

namespace annulus::random {

GearSet helical_pair_set(Draw& draw, Section section) {
  GearSet set;
  auto& draft = set.draft;
  draft.set("stage.kind", std::string("helical_pair"));
  const Rack rack = draw_rack(draw, section, draft);
  const long pinion = draw.integer(16, 40), wheel = pinion + draw.integer(0, 60);
  const double module = rack.transverse_module_mm(), angle = rack.transverse_pressure_angle();
  draft.set("pinion.teeth", pinion);
  draft.set("pinion.profile_shift", rounded(std::max(rack.least_profile_shift(pinion), draw.uniform(0, 0.5)), 3));
  draft.set("wheel.teeth", wheel);
  draft.set("wheel.profile_shift", rounded(std::max(rack.least_profile_shift(wheel), draw.uniform(-0.2, 0.3)), 3));
  const double force = rack.mesh_force(draw), base = module * static_cast<double>(pinion) / 2 * std::cos(angle) * 1e-3;
  draft.set("stage.pinion_torque_Nm", rounded(force * base * (draw.chance(0.03) ? -1 : 1)));
  draft.set("stage.pinion_speed_rpm", rounded(draw.log_uniform(10, 6000), 3));
  set.scales = {rack.module_mm, force / rack.mesh_stiffness() * 1e6, rack.mesh_stiffness(),
                rack.mesh_stiffness() * base * base};
  auto& v = set.values;
  v["stage.tip_shortening"] = std::string("none");  // the other shortens for a given centre distance
  for (const auto& [body, teeth] : {std::pair{"pinion", pinion}, {"wheel", wheel}}) {
    const std::string key = body;
    const double diameter = module * static_cast<double>(teeth);
    v[key + ".bore_diameter_mm"] = rounded((diameter - 2.5 * rack.module_mm) * draw.uniform(0.2, 0.7));
    const Disc disc = draw_disc(draw, diameter, rack.face_width_mm);
    v[key + ".mass_kg"] = disc.mass;
    v[key + ".inertia_kg_m2"] = disc.inertia;
    flank_keys(set, key, section);
    material_keys(draw, set, key, rack);
    face_keys(draw, set, key, rack);
    set.chances[key + ".bearing_transverse_N_per_m"] = set.chances[key + ".bearing_axial_N_per_m"] = 0.7;
    for (const auto* what : {"_total_um", "_tooth_to_tooth_um"})
      v["manufacturing_error." + key + what] =
          rounded(set.scales.deflection_um * (std::string(what) == "_total_um" ? 2 : 0.5) * draw.uniform(0.5, 1));
  }
  mesh_keys(set, "pinion_wheel", section);
  set.chances["errors"] = 0.8;
  // Phases that are stated: no samples are drawn of them.
  for (const auto* error : {"mesh", "pinion", "wheel"})
    set.chances[std::string("errors.") + error + "_error_phase_deg"] = 1;
  set.chances["mesh.pinion_wheel"] = 0.4;
  return set;
}

}  // namespace annulus::random
