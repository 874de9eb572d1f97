#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "app/plan/mesh_model.h"
#include "app/scene/key_checks.h"
#include "app/scene/planetary/planetary_scene.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/stage/gear_geometry.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class PlanetaryChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    planet_angles();
    errors();
    ring_names();
    // Problems of rings with the same name could not be assigned, so only the first one is checked.
    std::set<std::string> seen;
    for (auto& ring : scene_.rings) {
      if (seen.insert(ring.name).second) check_ring(ring);
    }
    wave(scene_.sun_planet, "mesh.sun_planet");
    wave(scene_.ring_planet, "mesh.ring_planet");
    resolved_model();
    axial_force();
    plane_models();
    rim_coupling();
  }

 private:
  void planet_angles() {
    const std::string key = "stage.planet_angles_deg";
    if (!given(key) || !usable(key) || !usable("stage.planets")) return;
    const auto& angles = scene_.stage.planet_angles;
    if (angles.size() != static_cast<std::size_t>(scene_.stage.planets)) {
      problem(key, "",
              fmt::format("needs one angle per planet: {} angles for {} planets", angles.size(), scene_.stage.planets));
    } else if (angles.front() != 0) {
      problem(key, "", "the first angle must be 0, from which the others are measured");
    } else if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) != angles.end() ||
               angles.back() >= 2 * std::numbers::pi) {
      problem(key, "", "angles must increase and stay below 360");
    }
  }

  void errors() {
    auto& e = scene_.errors;
    list("errors.planet_eccentricity_um", e.planet_eccentricity);
    list("errors.planet_eccentricity_phase_deg", e.planet_eccentricity_phase);
    list("errors.planet_pin_position_error_um", e.planet_installation);
    list("errors.planet_pin_position_error_phase_deg", e.planet_installation_phase);
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
    if (!usable("ring.structure", ring.name)) return;
    if (ring.structure == Structure::traditional) check_flange(ring);
    if (ring.structure == Structure::thin_walled) not_wider_than_face("ring.hoop_width_mm", ring.name, ring.hoop_width);
    if (ring.has_pins()) check_pins(ring);
  }

  /// Outside radius in m, when the scene defines it; what is missing is reported elsewhere.
  [[nodiscard]] std::optional<double> outside(const RingInput& ring) const {
    if (!ring.outside_diameter && !ring.rim_thickness) return std::nullopt;
    try {
      return outside_radius(scene_, ring);
    } catch (const GeometryError&) {
      return std::nullopt;
    }
  }

  void check_flange(const RingInput& ring) {
    not_wider_than_face("ring.flange_width_mm", ring.name, ring.flange_width);
    if (const auto radius = outside(ring); radius && ring.flange_diameter && *ring.flange_diameter <= 2 * *radius) {
      problem(
          "ring.flange_diameter_mm", ring.name,
          fmt::format("must be larger than the outside diameter, value > {} mm", to_text(2 * *radius / units::mm, 7)));
    }
  }

  void check_pins(RingInput& ring) {
    const bool equal = given("ring.pins", ring.name), listed = given("ring.pin_angles_deg", ring.name);
    if (listed && !equal && usable("ring.pin_angles_deg", ring.name)) listed_pins(ring);
    if (equal && !listed && ring.pins) equal_pins(ring);
    if (ring.pin_count() == 1) rest_in_bore(ring);
  }

  /// Gives the only pin of a ring a bore of the housing without play, unless the scene declares one.
  void rest_in_bore(RingInput& ring) {
    for (auto& input : scene_.inputs) {
      if (input.key != "ring.housing_clearance_um" || input.ring != ring.name || input.origin == Origin::scene)
        continue;
      input.value = 0.0;
      input.note = "a single pin cannot hold the ring alone: it rests in the bore of the housing";
      ring.housing_clearance = 0;
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

  /// Every pin needs an angular position of its own, and room for its diameter.
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
        if (apart < same) return problem("ring.pin_angles_deg", ring.name, which + " have the same angular position");
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

  void not_wider_than_face(const std::string& key, const std::string& ring, const std::optional<double>& width) {
    if (!width || !usable("stage.face_width_mm") || *width <= scene_.stage.face_width) return;
    problem(
        key, ring,
        fmt::format("must not exceed the face width, value <= {} mm", to_text(scene_.stage.face_width / units::mm)));
  }

  /// Rings on pins, bolts or splines.
  static bool on_single_supports(const RingInput& ring) {
    return ring.structure != Structure::traditional && ring.structure != Structure::thin_walled;
  }

  void resolved_model() {
    if (scene_.fidelity != Fidelity::resolved) return;
    if (scene_.ring_planet.stiffness == StiffnessShape::computed)
      for (const auto& ring : scene_.rings)
        if (on_single_supports(ring))
          problem("model", "",
                  fmt::format("cannot represent the ring-planet mesh of '{}': the resolved model does not cover rings "
                              "on pins, bolts or splines; use \"automatic\"",
                              ring.name));
    if (scene_.stage.helix_angle != 0)
      problem("model", "", "cannot represent helical gears: use \"automatic\" or \"solid\"");
  }

  void axial_force() {
    if (scene_.stage.helix_angle == 0 || scene_.ring_planet.stiffness != StiffnessShape::computed) return;
    for (const auto& ring : scene_.rings)
      if (on_single_supports(ring))
        problem("stage.helix_angle_deg", "",
                fmt::format("is not modelled for the ring '{}' on pins, bolts or splines: they do not carry the axial "
                            "force",
                            ring.name));
  }

  /// Models in which nothing changes along the face width are refused where something does.
  void plane_models() {
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
                "names a folder: letters, digits, '-', '_', '+' and '.' only, not starting with '.', at most 64");
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

  void rim_coupling() {
    if (!scene_.dynamics) return;
    const auto coupling = scene_.dynamics->rim_coupling;
    if (coupling != RimCoupling::elastic && coupling != RimCoupling::statical) return;
    if (scene_.ring_planet.stiffness != StiffnessShape::computed)
      problem("dynamics.rim_coupling", "",
              "needs a computed ring mesh: a prescribed stiffness does not describe the ring; use \"none\" or "
              "\"automatic\"");
    for (const auto& ring : scene_.rings)
      if (ring.has_pins() && ring.pin_count() == 1)
        problem("dynamics.rim_coupling", "",
                fmt::format("is not modelled for the ring '{}' on a single pin, which leans on its housing: use "
                            "\"none\" or \"automatic\", or give the ring more pins",
                            ring.name));
  }
};

}  // namespace

void check_planetary_scene(Scene& scene, std::vector<Problem>& problems) { PlanetaryChecker(scene, problems).run(); }

}  // namespace annulus::app
