#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/random/gear_sets.h"

namespace annulus::random {

GearSet two_k_v_set(Draw& draw, Section section) {
  GearSet set;
  auto& draft = set.draft;
  draft.set("stage.kind", std::string("two_k_v"));
  const Rack rack = draw_rack(draw, Section::plane, draft);
  const long sun = draw.integer(12, 24), planet = sun + draw.integer(14, 40), planets = draw.integer(2, 3);
  set.planets = static_cast<int>(planets);
  draft.set("stage.planets", planets);
  const double shift = rounded(std::max(rack.least_profile_shift(sun), draw.uniform(0.15, 0.4)), 3);
  draft.set("sun.teeth", sun);
  draft.set("sun.profile_shift", shift);
  draft.set("planet.teeth", planet);
  draft.set("planet.profile_shift", -shift);

  // The arc gears are about as large as the planets reach.
  const long pins = draw.integer(16, 60);
  const double reach = rack.module_mm * static_cast<double>(sun + 2 * planet) / 2;
  const double circle = rounded(2 * reach * draw.uniform(0.9, 1.3)),
               eccentricity = rounded(circle / 2 / static_cast<double>(pins) * draw.uniform(0.4, 0.8));
  const double pin = rounded(circle * std::sin(std::numbers::pi / static_cast<double>(pins)) * draw.uniform(0.4, 0.7));
  const double width = rounded(pin * draw.uniform(1, 4));
  draft.set("arc_gear.pins", pins);
  draft.set("arc_gear.eccentricity_mm", eccentricity);

  // The load of the involute meshes, by the ratio of the whole reducer: 1 + planet teeth / sun teeth x pins, about.
  const double ratio = 1 + static_cast<double>(planet * pins) / static_cast<double>(sun);
  const double force = rack.mesh_force(draw) * 0.3;
  const double sun_base =
      rack.module_mm * static_cast<double>(sun) / 2 * std::cos(rack.transverse_pressure_angle()) * 1e-3;
  const double torque = force * sun_base * static_cast<double>(planets);
  draft.set("output.torque_Nm", rounded(torque * ratio));
  draft.set("output.speed_rpm", rounded(draw.log_uniform(1, 60), 3));
  set.scales = {rack.module_mm, force / rack.mesh_stiffness() * 1e6, rack.mesh_stiffness(),
                rack.mesh_stiffness() * sun_base * sun_base};

  auto& v = set.values;
  v["arc_gear.pin_circle_diameter_mm"] = circle;
  v["arc_gear.pin_diameter_mm"] = pin;
  v["arc_gear.arc_radius_mm"] = rounded(pin / 2 * draw.uniform(1.05, 1.4));
  v["arc_gear.width_mm"] = width;
  v["sun.bore_diameter_mm"] = rounded(rack.module_mm * (static_cast<double>(sun) - 3) * draw.uniform(0.3, 0.6));
  v["planet.bore_diameter_mm"] = rounded(rack.module_mm * (static_cast<double>(planet) - 3.5) * draw.uniform(0.3, 0.6));
  for (const auto& [body, diameter, wide] :
       {std::tuple{"sun", rack.module_mm * static_cast<double>(sun), rack.face_width_mm},
        {"planet", rack.module_mm * static_cast<double>(planet), rack.face_width_mm},
        {"arc_gear", circle, width},
        {"crank", 3 * eccentricity, 8 * width},
        {"output", circle, 4 * width},
        {"input", rack.module_mm * static_cast<double>(sun), 8 * rack.face_width_mm}}) {
    const Disc disc = draw_disc(draw, diameter, wide);
    v[std::string(body) + ".mass_kg"] = disc.mass;
    v[std::string(body) + ".inertia_kg_m2"] = disc.inertia;
  }
  const double arm = circle / 2 * 1e-3;
  v["output.support_Nm_per_rad"] = draw.chance(0.5)
                                       ? std::numeric_limits<double>::infinity()
                                       : rounded(set.scales.stiffness_N_per_m * arm * arm * draw.log_uniform(0.1, 10));
  set.chances["arc_gear.clearance_um"] = 0.2;
  set.chances["input"] = 1;
  for (const auto* body : {"sun", "planet"}) {
    flank_keys(set, body, section);
    material_keys(draw, set, body, rack);
    face_keys(draw, set, body, rack);
  }
  set.chances["mesh.sun_planet"] = 0.3;
  set.chances["mesh.arc_pins"] = 0.5;
  return set;
}

}  // namespace annulus::random
