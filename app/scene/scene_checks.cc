#include "app/scene/scene_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "app/plan/mesh_model.h"
#include "app/scene/key_checks.h"
#include "app/scene/pair_checks.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/stage/gear_geometry.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class Checker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    speed();
    planet_angles();
    errors();
    ring_names();
    // Rings of the same name cannot be told apart by the rules between keys, so only the first one is checked.
    std::set<std::string> seen;
    for (auto& ring : scene_.rings) {
      if (seen.insert(ring.name).second) check_ring(ring);
    }
    mesh(scene_.sun_planet, "mesh.sun_planet");
    mesh(scene_.ring_planet, "mesh.ring_planet");
    computed_meshes();
    fidelity();
    dynamics();
  }

 private:
  void speed() {
    const bool sun = given("stage.sun_speed_rpm"), carrier = given("stage.carrier_speed_rpm");
    if (sun && carrier) {
      problem("stage.carrier_speed_rpm", "",
              "give either sun_speed_rpm or carrier_speed_rpm, one follows from the other");
    } else if (!sun && !carrier && usable("stage.kind")) {
      problem("stage.sun_speed_rpm", "",
              "give the speed of the sun (sun_speed_rpm) or of the carrier (carrier_speed_rpm)");
    }
  }

  void planet_angles() {
    const std::string key = "stage.planet_angles_deg";
    if (!given(key) || !usable(key) || !usable("stage.planets")) return;
    const auto& angles = scene_.stage.planet_angles;
    if (angles.size() != static_cast<std::size_t>(scene_.stage.planets)) {
      problem(key, "",
              fmt::format("needs one angle per planet: {} angles for {} planets", angles.size(), scene_.stage.planets));
    } else if (angles.front() != 0) {
      problem(key, "", "the first planet stands at 0, the others are counted from it");
    } else if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) != angles.end() ||
               angles.back() >= 2 * std::numbers::pi) {
      problem(key, "", "angles have to rise, and to stay below 360");
    }
  }

  void errors() {
    auto& e = scene_.errors;
    list("errors.planet_eccentricity_um", e.planet_eccentricity);
    list("errors.planet_eccentricity_phase_deg", e.planet_eccentricity_phase);
    list("errors.planet_installation_um", e.planet_installation);
    list("errors.planet_installation_phase_deg", e.planet_installation_phase);
  }

  void list(const std::string& key, std::vector<double>& values) {
    if (!usable("stage.planets") || (given(key) && !usable(key))) return;
    const auto planets = static_cast<std::size_t>(scene_.stage.planets);
    if (values.empty() && !given(key)) values.assign(planets, 0);
    if (values.size() != planets) {
      problem(key, "", fmt::format("needs one value per planet: {} values for {} planets", values.size(), planets));
    }
  }

  void check_ring(RingInput& ring) {
    const auto& name = ring.name;
    const bool diameter = given("ring.outside_diameter_mm", name), thickness = given("ring.rim_thickness_mm", name);
    if (diameter && thickness) {
      problem("ring.rim_thickness_mm", name,
              "give either outside_diameter_mm or rim_thickness_mm, one follows from the other");
    } else if (!diameter && !thickness) {
      problem("ring.outside_diameter_mm", name, "give outside_diameter_mm or rim_thickness_mm");
    }
    if (!usable("ring.structure", name)) return;
    check_flange(ring);
    check_sleeve(ring);
    check_pins(ring);
    check_splines(ring);
    check_clamp(ring);
  }

  /// Outside radius in m, when the scene tells enough; what is missing is reported elsewhere.
  [[nodiscard]] std::optional<double> outside(const RingInput& ring) const {
    if (!ring.outside_diameter && !ring.rim_thickness) return std::nullopt;
    try {
      return outside_radius(scene_, ring);
    } catch (const GeometryError&) {
      return std::nullopt;
    }
  }

  void check_flange(const RingInput& ring) {
    const auto& name = ring.name;
    const bool held_outside = ring.structure == Structure::traditional;
    forbidden_unless(held_outside, {"ring.flange_width_mm", "ring.flange_diameter_mm"}, name,
                     "structure = \"traditional\"");
    if (!held_outside) return;
    both_or_none("ring.flange_width_mm", "ring.flange_diameter_mm", name);
    not_wider_than_face("ring.flange_width_mm", name, ring.flange_width);
    if (const auto radius = outside(ring); radius && ring.flange_diameter && *ring.flange_diameter <= 2 * *radius) {
      problem(
          "ring.flange_diameter_mm", name,
          fmt::format("must be larger than the outside diameter, value > {} mm", to_text(2 * *radius / units::mm, 7)));
    }
  }

  void check_sleeve(const RingInput& ring) {
    const auto& name = ring.name;
    const bool sleeve = ring.structure == Structure::thin_walled;
    constexpr const char* thin_walled = "structure = \"thin_walled\"";
    required_if(sleeve, {"ring.free_length_mm", "ring.sleeve_thickness_mm"}, name, thin_walled);
    forbidden_unless(
        sleeve, {"ring.free_length_mm", "ring.sleeve_thickness_mm", "ring.hoop_width_mm", "ring.hoop_thickness_mm"},
        name, thin_walled);
    if (!sleeve) return;
    both_or_none("ring.hoop_width_mm", "ring.hoop_thickness_mm", name);
    not_wider_than_face("ring.hoop_width_mm", name, ring.hoop_width);
  }

  void check_pins(RingInput& ring) {
    const auto& name = ring.name;
    const bool pins = ring.has_pins();
    constexpr const char* pinned = "structure = \"pinned\" or \"bolted\"";
    required_if(pins, {"ring.pin_diameter_mm"}, name, pinned);
    forbidden_unless(pins,
                     {"ring.pins", "ring.pin_angles_deg", "ring.first_pin_angle_deg", "ring.pin_diameter_mm",
                      "ring.pin_clearance_um", "ring.pin_radial_stiffness_N_per_m",
                      "ring.pin_tangential_stiffness_N_per_m", "ring.pin_free_span_mm", "ring.housing_clearance_um"},
                     name, pinned);
    forbidden_unless(ring.structure != Structure::bolted, {"ring.pin_clearance_um"}, name, "structure = \"pinned\"");
    if (!pins) return;
    const bool equal = given("ring.pins", name), listed = given("ring.pin_angles_deg", name);
    if (!equal && !listed) {
      problem("ring.pins", name, fmt::format("pins or pin_angles_deg is required by {}", pinned));
    } else if (equal && listed) {
      problem("ring.pin_angles_deg", name, "give either pins (equally spaced) or pin_angles_deg (the place of each)");
    } else if (listed) {
      if (given("ring.first_pin_angle_deg", name))
        problem("ring.first_pin_angle_deg", name, "has a meaning only with pins; pin_angles_deg places every pin");
      if (usable("ring.pin_angles_deg", name)) listed_pins(ring);
    } else if (ring.pins) {
      equal_pins(ring);
    }
    if (equal && !listed) fall_back("ring.first_pin_angle_deg", name, ring.first_pin_angle, 0, "behind tooth 0");
    if (ring.structure == Structure::pinned) fall_back("ring.pin_clearance_um", name, ring.pin_clearance, 0, "no play");
    fall_back("ring.pin_free_span_mm", name, ring.pin_free_span, 0, "no bending of the pin");
    if (ring.pin_count() == 1) {
      fall_back("ring.housing_clearance_um", name, ring.housing_clearance, 0,
                "a single pin cannot hold the ring alone: it rests in the bore of the housing");
    }
  }

  void equal_pins(const RingInput& ring) {
    const auto radius = outside(ring);
    if (!radius || !ring.pin_diameter || *ring.pins < 2) return;
    const double distance = 2 * *radius * std::sin(std::numbers::pi / *ring.pins);
    if (distance >= *ring.pin_diameter) return;
    problem("ring.pins", ring.name,
            fmt::format("pins overlap: their centres are {} mm apart on the outside, less than pin_diameter_mm = {}",
                        to_text(distance / units::mm, 4), to_text(*ring.pin_diameter / units::mm)));
  }

  /// Every pin needs a place of its own, and room for its diameter.
  void listed_pins(const RingInput& ring) {
    const auto& angles = ring.pin_angles;
    if (angles.empty()) {
      return problem("ring.pin_angles_deg", ring.name, fmt::format("needs at least one angle, {}", angle_range()));
    }
    const auto radius = outside(ring);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      for (std::size_t j = i + 1; j < angles.size(); ++j) {
        const double apart = std::abs(std::remainder(angles[i] - angles[j], 2 * std::numbers::pi));
        const std::string which = fmt::format("pins {} and {} ({}° and {}°)", i + 1, j + 1,
                                              to_text(angles[i] / units::deg), to_text(angles[j] / units::deg));
        constexpr double same = 1e-9;  // rad: beyond the rounding of degrees
        if (apart < same) return problem("ring.pin_angles_deg", ring.name, which + " are at the same place");
        const double distance = radius ? 2 * *radius * std::sin(apart / 2) : 0;
        if (radius && ring.pin_diameter && distance < *ring.pin_diameter) {
          return problem("ring.pin_angles_deg", ring.name,
                         fmt::format("{} overlap: their centres are {} mm apart on the outside, less than "
                                     "pin_diameter_mm = {}",
                                     which, to_text(distance / units::mm, 4), to_text(*ring.pin_diameter / units::mm)));
        }
      }
    }
  }

  static std::string angle_range() { return find_parameter("ring.pin_angles_deg")->range_text(); }

  void check_splines(RingInput& ring) {
    const auto& name = ring.name;
    const bool splined = ring.structure == Structure::splined;
    constexpr const char* why = "structure = \"splined\"";
    required_if(splined, {"ring.splines"}, name, why);
    forbidden_unless(splined,
                     {"ring.splines", "ring.first_spline_angle_deg", "ring.spline_flank_angle_deg",
                      "ring.spline_clearance_um", "ring.spline_stiffness_N_per_m"},
                     name, why);
    if (!splined) return;
    fall_back("ring.first_spline_angle_deg", name, ring.first_spline_angle, 0, "behind tooth 0");
    fall_back("ring.spline_flank_angle_deg", name, ring.spline_flank_angle, 30, "the pressure angle of ISO 4156");
    fall_back("ring.spline_clearance_um", name, ring.spline_clearance, 0, "no play");
  }

  void check_clamp(RingInput& ring) {
    const auto& name = ring.name;
    const bool clamped = ring.structure == Structure::clamped;
    constexpr const char* why = "structure = \"clamped\"";
    const std::vector<std::string> needed = {"ring.clamp_inner_diameter_mm", "ring.bolts",
                                             "ring.bolt_circle_diameter_mm", "ring.bolt_diameter_mm"};
    required_if(clamped, needed, name, why);
    forbidden_unless(clamped, needed, name, why);
    forbidden_unless(clamped, {"ring.first_bolt_angle_deg", "ring.dowels", "ring.dowel_diameter_mm"}, name, why);
    if (!clamped) return;
    fall_back("ring.first_bolt_angle_deg", name, ring.first_bolt_angle, 0, "behind tooth 0");
    both_or_none("ring.dowels", "ring.dowel_diameter_mm", name);
    const auto radius = outside(ring);
    if (radius && ring.clamp_inner_diameter && *ring.clamp_inner_diameter >= 2 * *radius)
      problem(
          "ring.clamp_inner_diameter_mm", name,
          fmt::format("must be smaller than the outside diameter, value < {} mm", to_text(2 * *radius / units::mm, 7)));
    if (ring.clamp_inner_diameter && ring.bolt_circle_diameter && ring.bolt_diameter && ring.bolts) bolt_circle(ring);
  }

  /// Bolts and dowels lie in the clamped annulus and leave each other room.
  void bolt_circle(const RingInput& ring) {
    const double circle = *ring.bolt_circle_diameter, bolt = *ring.bolt_diameter;
    const double widest = std::max(bolt, ring.dowel_diameter.value_or(0));
    const auto mm = [](double length) { return to_text(length / units::mm, 7); };
    const auto radius = outside(ring);
    const double least = *ring.clamp_inner_diameter + widest;
    if (circle < least || (radius && circle > 2 * *radius - widest))
      problem("ring.bolt_circle_diameter_mm", ring.name,
              fmt::format("bolts and dowels of up to {} mm have to lie in the clamped end faces: {} mm <= value{}",
                          mm(widest), mm(least), radius ? fmt::format(" <= {} mm", mm(2 * *radius - widest)) : ""));
    const double apart = circle * std::sin(std::numbers::pi / *ring.bolts);
    if (apart < bolt)
      problem(
          "ring.bolts", ring.name,
          fmt::format("bolts overlap: their centres are {} mm apart on the bolt circle, less than bolt_diameter_mm = "
                      "{}",
                      to_text(apart / units::mm, 4), mm(bolt)));
    if (!ring.dowels || !ring.dowel_diameter) return;
    if (*ring.dowels > *ring.bolts)
      problem("ring.dowels", ring.name,
              fmt::format("there is room for one dowel between two bolts, value <= bolts = {}", *ring.bolts));
    const double beside = circle * std::sin(std::numbers::pi / 2 / *ring.bolts);
    if (apart >= bolt && beside < (bolt + *ring.dowel_diameter) / 2)
      problem("ring.dowel_diameter_mm", ring.name,
              fmt::format("dowels overlap the bolts, whose centres are {} mm away: value <= {} mm",
                          to_text(beside / units::mm, 4), mm(2 * beside - bolt)));
  }

  /// Gives an absent key of this ring's structure its default, in the unit of the key, and lists it among the inputs.
  void fall_back(const std::string& key, const std::string& ring, std::optional<double>& member, double value,
                 const char* why) {
    for (auto& input : scene_.inputs) {
      if (input.key != key || input.ring != ring || input.origin == Origin::scene) continue;
      input.value = value;
      input.note = why;
      member = value * find_parameter(key)->si;
    }
  }

  void both_or_none(const std::string& a, const std::string& b, const std::string& ring) {
    const bool has_a = given(a, ring), has_b = given(b, ring);
    if (has_a != has_b) problem(has_a ? a : b, ring, fmt::format("needs {} as well", has_a ? b : a));
  }

  void not_wider_than_face(const std::string& key, const std::string& ring, const std::optional<double>& width) {
    if (!width || !usable("stage.face_width_mm") || *width <= scene_.stage.face_width) return;
    problem(
        key, ring,
        fmt::format("must not exceed the face width, value <= {} mm", to_text(scene_.stage.face_width / units::mm)));
  }

  /// Models in which nothing changes along the face width are refused where something does.
  void fidelity() {
    if (scene_.fidelity == Fidelity::resolved && scene_.ring_planet.stiffness == StiffnessShape::computed)
      for (const auto& ring : scene_.rings)
        if (fem::on_single_supports(ring_structure(ring)))
          problem(
              "model", "",
              fmt::format("cannot represent the ring-planet mesh of '{}': the resolved model does not cover rings on "
                          "pins, bolts or splines; use \"automatic\"",
                          ring.name));
    if (scene_.fidelity == Fidelity::resolved && scene_.stage.helix_angle != 0)
      problem("model", "", "cannot represent helical gears: use \"automatic\" or \"solid\"");
    if (scene_.stage.helix_angle != 0 && scene_.ring_planet.stiffness == StiffnessShape::computed)
      for (const auto& ring : scene_.rings)
        if (fem::on_single_supports(ring_structure(ring)))
          problem("stage.helix_angle_deg", "",
                  fmt::format("is not modelled for the ring '{}' on pins, bolts or splines: nothing there takes the "
                              "axial force",
                              ring.name));
    if (scene_.fidelity != Fidelity::plane && scene_.fidelity != Fidelity::closed_form) return;
    const auto refuse = [&](const std::string& mesh, const std::string& why) {
      if (why.empty()) return;
      problem("model", "",
              fmt::format("cannot represent the {}: {}; use \"automatic\", \"solid\" or \"resolved\"", mesh, why));
    };
    if (scene_.sun_planet.stiffness == StiffnessShape::computed) refuse("sun-planet mesh", solid_reason(scene_));
    if (scene_.ring_planet.stiffness != StiffnessShape::computed) return;
    for (const auto& ring : scene_.rings)
      refuse(fmt::format("ring-planet mesh of '{}'", ring.name), solid_reason(scene_, ring));
  }

  void ring_names() {
    constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.";
    std::set<std::string> seen;
    for (const auto& ring : scene_.rings) {
      if (seen.contains(ring.name)) continue;
      seen.insert(ring.name);
      const bool good = !ring.name.empty() && ring.name.front() != '.' &&
                        ring.name.find_first_not_of(allowed) == std::string::npos && ring.name.size() <= 64;
      if (!good) {
        problem("ring.name", ring.name,
                "names a folder: letters, digits, '-', '_', '+' and '.' only, not starting with '.'");
      }
    }
    seen.clear();
    for (const auto& input : scene_.inputs) {
      if (input.key != "ring.name" || seen.insert(input.ring).second) continue;
      problems_.push_back(
          {input.line, input.column,
           fmt::format("ring.name = {}: is the name of more than one ring; each needs its own", shown(input.ring))});
    }
  }

  void computed_meshes() {
    const auto bore = [&](const char* key, bool computed, const char* which) {
      if (computed && !given(key)) problem(key, "", fmt::format("is required because the {} mesh is computed", which));
    };
    const bool sun = scene_.sun_planet.stiffness == StiffnessShape::computed;
    const bool ring = scene_.ring_planet.stiffness == StiffnessShape::computed;
    bore("sun.bore_diameter_mm", sun, "sun-planet");
    bore("planet.bore_diameter_mm", sun || ring, sun ? "sun-planet" : "ring-planet");
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    const auto need = [&](const std::string& key, const std::string& ring = "") {
      if (!given(key, ring)) problem(key, ring, "is required by [dynamics]");
    };
    need("sun.mass_kg");
    need("sun.inertia_kg_m2");
    need("planet.mass_kg");
    need("planet.inertia_kg_m2");
    need("carrier.mass_kg");
    need("carrier.inertia_kg_m2");
    for (const auto& ring : scene_.rings) {
      need("ring.mass_kg", ring.name);
      need("ring.inertia_kg_m2", ring.name);
    }
    integrator();
    const auto coupling = scene_.dynamics->rim_coupling;
    if (coupling != RimCoupling::elastic && coupling != RimCoupling::statical) return;
    if (scene_.ring_planet.stiffness != StiffnessShape::computed)
      problem("dynamics.rim_coupling", "",
              "needs a computed ring mesh: a given stiffness tells nothing about the ring");
    for (const auto& ring : scene_.rings)
      if (ring.has_pins() && ring.pin_count() == 1)
        problem("dynamics.rim_coupling", "",
                fmt::format("is not modelled for the ring '{}' on a single pin, which leans on its housing: use "
                            "\"none\" or \"automatic\", or give the ring more pins",
                            ring.name));
  }
};

}  // namespace

void complete_and_check(Scene& scene, std::vector<Problem>& problems) {
  switch (scene.stage.kind) {
    case StageKind::planetary:
      Checker(scene, problems).run();
      break;
    case StageKind::helical_pair:
      complete_and_check_pair(scene, problems);
      break;
    case StageKind::two_k_v:
      check_two_k_v_keys(scene, problems);
      break;
  }
  // Paths are looked up among the inputs, which have to be right for that.
  if (problems.empty()) check_study_keys(scene, problems);
}

}  // namespace annulus::app
