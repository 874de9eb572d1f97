#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/units.h"
#include "geometry/gear.h"
#include "tests/random/gear_sets.h"

namespace annulus::random {

namespace {

using geometry::inverse_involute;
using geometry::involute;

struct Teeth {
  int sun = 0, planet = 0, ring = 0, planets = 1;
};

/// Numbers of teeth for planets that have room beside each other.
Teeth draw_teeth(Draw& draw) {
  for (;;) {
    Teeth teeth;
    teeth.planets = static_cast<int>(draw.integer(1, 7));
    teeth.sun = static_cast<int>(draw.integer(14, 50));
    teeth.planet = static_cast<int>(draw.integer(14, 50));
    teeth.ring = teeth.sun + 2 * teeth.planet + static_cast<int>(draw.integer(-1, 1));
    const double room = (teeth.sun + teeth.planet) * std::sin(std::numbers::pi / std::max(teeth.planets, 2));
    if (teeth.planets > 1 && room < teeth.planet + 4) continue;
    if (teeth.ring - teeth.planet >= 24) return teeth;
  }
}

/// Where planets fit between the teeth: multiples of 360 / (sun + ring), close to equal spacing. Empty: equally spaced.
std::vector<double> planet_angles(const Teeth& teeth) {
  const int sum = teeth.sun + teeth.ring;
  if (sum % teeth.planets == 0) return {};
  std::vector<double> angles;
  for (int n = 0; n < teeth.planets; ++n)
    angles.push_back(360.0 * std::lround(static_cast<double>(sum) * n / teeth.planets) / sum);
  return angles;
}

/// Who is held and drives, how fast, and the power at this torque of the sun, N m.
void power_flow(Draw& draw, const Teeth& teeth, double sun_torque, GearSet& set) {
  auto& draft = set.draft;
  const std::vector<std::string> members = {"sun", "carrier", "ring"};
  const auto held = draw.one_of<std::string>({"ring", "ring", "ring", "sun", "carrier", "none"});
  std::vector<std::string> turning;
  for (const auto& member : members)
    if (member != held) turning.push_back(member);
  const auto drives = held == "ring" && draw.chance(0.6) ? std::string("sun") : draw.one_of(turning);
  if (held != "ring" || draw.chance(0.2)) draft.set("stage.held", held);
  if (drives != "sun" || draw.chance(0.2)) draft.set("stage.drives", drives);
  const auto speed = [&] { return rounded(draw.log_uniform(10, 6000) * (draw.chance(0.2) ? -1 : 1), 3); };
  const double driving = speed();
  draft.set("stage." + drives + "_speed_rpm", driving);
  for (const auto& member : members) set.chances["stage." + member + "_speed_rpm"] = 0;
  if (held == "none") {
    std::erase(turning, drives);
    draft.set("stage." + draw.one_of(turning) + "_speed_rpm", speed());
  }
  const double ring_share = static_cast<double>(teeth.ring) / teeth.sun;
  const double of_sun = drives == "sun" ? 1 : drives == "ring" ? ring_share : 1 + ring_share;
  draft.set("stage.power_kW", rounded(sun_torque * of_sun * std::abs(driving) * std::numbers::pi / 30 / 1e3));
}

/// What the supports of the ring need to fit it.
void ring_values(Draw& draw, const Rack& rack, double root_mm, Section section, const Teeth& teeth, GearSet& set) {
  const double rim = rounded(rack.module_mm * draw.log_uniform(0.8, 8)), outside = root_mm + 2 * rim;
  auto& draft = set.draft;
  auto& v = set.values;
  draft.set("ring.name", std::string("ring"));
  std::vector<std::string> structures = {"traditional", "traditional", "pinned", "bolted", "splined"};
  if (section == Section::solid) structures = {"traditional", "thin_walled", "clamped"};
  if (section == Section::resolved) structures = {"traditional"};
  draft.set("ring.structure", draw.one_of(structures));
  if (draw.chance(0.5))
    draft.set("ring.rim_thickness_mm", rim);
  else
    draft.set("ring.outside_diameter_mm", rounded(outside, 6));
  set.chances["supports"] = 1;
  set.chances["supports.planet_N_per_m"] = 0.7;
  set.chances["supports.planet_clearance_um"] = 0.3;
  set.chances["planet.bore"] = 0;  // see put_planets_on_rollers()
  // Phases that are stated: no samples are drawn of them.
  for (const auto* body :
       {"planet_eccentricity", "planet_pin_position_error", "sun_eccentricity", "sun_position_error",
        "ring_eccentricity", "ring_position_error", "carrier_eccentricity", "carrier_position_error"})
    set.chances[std::string("errors.") + body + "_phase_deg"] = 1;
  set.chances["ring.rim_thickness_mm"] = set.chances["ring.outside_diameter_mm"] = 0;
  v["ring.root_fillet_factor"] = rounded(draw.uniform(0.2, 0.45), 3);
  v["ring.flange_width_mm"] = rounded(rack.face_width_mm * draw.uniform(0.15, 0.5));
  v["ring.flange_diameter_mm"] = rounded(outside * draw.uniform(1.05, 1.3));
  v["ring.free_length_mm"] = rounded(rack.face_width_mm * draw.uniform(0, 0.6));
  v["ring.sleeve_thickness_mm"] = rounded(rim * draw.uniform(0.3, 1));
  set.chances["ring.sleeve_thickness_mm"] = 1;
  v["ring.hoop_width_mm"] = rounded(rack.face_width_mm * draw.uniform(0.1, 0.3));
  v["ring.hoop_thickness_mm"] = rounded(rim * draw.uniform(0.3, 1));
  if (section != Section::solid) set.chances["ring.flange_width_mm"] = set.chances["ring.flange_diameter_mm"] = 0;
  // A number that divides the teeth often keeps sectors equal, and with that costs.
  const auto equal = [&](long low, long high) {
    return draw.chance(0.4) ? static_cast<long>(teeth.ring) : draw.integer(low, high);
  };
  const long pins = equal(4, 40);
  v["ring.pins"] = pins;
  v["ring.pin_diameter_mm"] = rounded(
      std::min(rim * draw.uniform(0.3, 0.9), 0.7 * outside * std::sin(std::numbers::pi / static_cast<double>(pins))));
  set.chances["ring.pins"] = 1;
  std::vector<double> listed;
  for (long n = 0; n < pins; ++n)
    listed.push_back(rounded((static_cast<double>(n) + draw.uniform(-0.1, 0.1)) * 360 / static_cast<double>(pins), 6));
  if (draw.chance(0.2)) {
    v["ring.pin_angles_deg"] = listed;
    set.chances["ring.pins"] = 0;
    set.chances["ring.pin_angles_deg"] = 1;
  } else {
    set.chances["ring.pin_angles_deg"] = 0;
  }
  v["ring.first_pin_angle_deg"] = rounded(draw.uniform(-180, 180));
  v["ring.pin_free_span_mm"] = rounded(rack.module_mm * draw.uniform(0, 1));
  v["ring.pin_clearance_um"] = rounded(set.scales.deflection_um * draw.log_uniform(0.05, 2), 3);
  v["ring.housing_clearance_um"] = rounded(set.scales.deflection_um * draw.log_uniform(0.2, 5), 3);
  const long splines = equal(6, 60);
  v["ring.splines"] = splines;
  v["ring.first_spline_angle_deg"] = rounded(draw.uniform(-180, 180));
  v["ring.spline_flank_angle_deg"] = rounded(draw.uniform(10, 40));
  const double clamp = root_mm + rim * draw.uniform(0.2, 0.6),
               bolt = rounded((outside - clamp) / 2 * draw.uniform(0.2, 0.45));
  const double circle = (clamp + outside) / 2;
  v["ring.clamp_inner_diameter_mm"] = rounded(clamp, 6);
  v["ring.bolt_diameter_mm"] = bolt;
  v["ring.bolt_circle_diameter_mm"] = rounded(circle, 6);
  const long bolts = std::clamp(equal(6, 30), 3L, static_cast<long>(std::numbers::pi * circle / bolt / 3));
  v["ring.bolts"] = bolts;
  v["ring.first_bolt_angle_deg"] = rounded(draw.uniform(-180, 180));
  v["ring.dowels"] = draw.integer(1, bolts);
  v["ring.dowel_diameter_mm"] = rounded(bolt * draw.uniform(0.5, 0.9));
}

}  // namespace

GearSet planetary_set(Draw& draw, Section section) {
  GearSet set;
  auto& draft = set.draft;
  draft.set("stage.kind", std::string("planetary"));
  const Rack rack = draw_rack(draw, section, draft);
  const Teeth teeth = draw_teeth(draw);
  set.planets = teeth.planets;
  draft.set("stage.planets", static_cast<long>(teeth.planets));
  if (const auto angles = planet_angles(teeth); !angles.empty()) draft.set("stage.planet_angles_deg", angles);
  set.chances["stage.planet_angles_deg"] = 0;

  // Centre distance from the sun mesh without backlash, and the ring's profile shift from that.
  const double module = rack.transverse_module_mm(), angle = rack.transverse_pressure_angle();
  const double normal = std::tan(rack.pressure_angle_deg * units::deg);
  const double sun_shift = rounded(std::max(rack.least_profile_shift(teeth.sun), draw.uniform(0, 0.6)), 3);
  const double planet_shift = rounded(std::max(rack.least_profile_shift(teeth.planet), draw.uniform(-0.1, 0.5)), 3);
  const int sum = teeth.sun + teeth.planet, difference = teeth.ring - teeth.planet;
  const double working = inverse_involute(involute(angle) + 2 * normal * (sun_shift + planet_shift) / sum);
  const double centre = rounded(module * sum / 2 * std::cos(angle) / std::cos(working), 7);
  const double inner =
      std::acos(std::min(module * difference / 2 * std::cos(angle) / centre, std::cos(5 * units::deg)));
  const double ring_shift = rounded(
      planet_shift + difference * (involute(inner) - involute(angle)) / (2 * normal) + draw.uniform(0, 0.01), 5);
  draft.set("stage.centre_distance_mm", centre);
  draft.set("sun.teeth", static_cast<long>(teeth.sun));
  draft.set("sun.profile_shift", sun_shift);
  draft.set("planet.teeth", static_cast<long>(teeth.planet));
  draft.set("planet.profile_shift", planet_shift);
  draft.set("ring.teeth", static_cast<long>(teeth.ring));
  draft.set("ring.profile_shift", ring_shift);
  // The ring's tip stays outside the circle where its involute would meet the base of the planet's line of action.
  const double base = module * teeth.ring / 2 * std::cos(angle), reach = centre * std::sin(inner);
  const double normal_tip = module * teeth.ring + 2 * rack.module_mm * (ring_shift - 0.9);
  const double tip = std::max(normal_tip, 2 * std::hypot(base, reach) + 0.1 * rack.module_mm);
  draft.set("ring.tip_diameter_mm", rounded(tip, 6));

  const double force = rack.mesh_force(draw), sun_base = module * teeth.sun / 2 * std::cos(angle) * 1e-3;
  power_flow(draw, teeth, force * sun_base * teeth.planets, set);
  set.scales = {rack.module_mm, force / rack.mesh_stiffness() * 1e6, rack.mesh_stiffness(),
                rack.mesh_stiffness() * sun_base * sun_base};

  const double sun_mm = module * teeth.sun, planet_mm = module * teeth.planet;
  const double root_mm = module * teeth.ring + 2 * rack.module_mm * (ring_shift + 1.25);
  ring_values(draw, rack, root_mm, section, teeth, set);
  auto& v = set.values;
  v["sun.bore_diameter_mm"] = rounded((sun_mm - 2.5 * rack.module_mm) * draw.uniform(0.3, 0.7));
  v["planet.bore_diameter_mm"] = rounded((planet_mm - 2.5 * rack.module_mm) * draw.uniform(0.3, 0.7));
  for (const auto& [body, diameter, width] : {std::tuple{"sun", sun_mm, rack.face_width_mm},
                                              {"planet", planet_mm, rack.face_width_mm},
                                              {"ring", root_mm, 0.3 * rack.face_width_mm},
                                              {"carrier", 2 * centre, 2 * rack.face_width_mm}}) {
    const Disc disc = draw_disc(draw, diameter, width);
    v[std::string(body) + ".mass_kg"] = disc.mass;
    v[std::string(body) + ".inertia_kg_m2"] = disc.inertia;
  }
  for (const auto* body : {"sun", "planet", "ring"}) {
    flank_keys(set, body, section);
    material_keys(draw, set, body, rack);
    face_keys(draw, set, body, rack);
  }
  for (const auto* mesh : {"sun_planet", "ring_planet"}) mesh_keys(set, mesh, section);
  set.chances["carrier"] = 1;
  set.chances["errors"] = 0.8;
  set.chances["mesh.sun_planet"] = set.chances["mesh.ring_planet"] = 0.15;
  // Torsional supports fit who is held; drawn ones would often contradict it.
  for (const auto* body : {"sun", "carrier", "ring"}) {
    const auto held = draft.text_of("stage.held");
    if ((held.empty() ? "ring" : held) != body) set.chances[std::string("supports.") + body + "_torsional_N_per_m"] = 0;
  }
  const auto coupling = draw.one_of<std::string>({"automatic", "none", "static", "elastic"});
  const auto held = draft.text_of("stage.held");
  v["dynamics.rim_coupling"] = coupling == "elastic" && !held.empty() && held != "ring" ? "static" : coupling;
  set.chances["dynamics.rim_coupling"] = 0.15;
  if (coupling == "static" || coupling == "elastic") set.chances["mesh.ring_planet"] = 0;
  return set;
}

}  // namespace annulus::random
