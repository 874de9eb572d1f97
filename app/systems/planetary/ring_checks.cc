#include "app/systems/planetary/ring_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/plan/gear_geometry.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class RingChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void check(RingInput& ring) {
    if (!usable("ring.structure", ring.name)) return;
    if (ring.structure == Structure::traditional) check_flange(ring);
    if (ring.structure == Structure::thin_walled) not_wider_than_face("ring.hoop_width_mm", ring.name, ring.hoop_width);
    if (ring.has_pins()) check_pins(ring);
    if (ring.structure == Structure::clamped) check_clamp(ring);
  }

 private:
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

  void check_clamp(const RingInput& ring) {
    const auto radius = outside(ring);
    if (radius && ring.clamp_inner_diameter && *ring.clamp_inner_diameter >= 2 * *radius)
      return problem(
          "ring.clamp_inner_diameter_mm", ring.name,
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

  void not_wider_than_face(const std::string& key, const std::string& ring, const std::optional<double>& width) {
    if (!width || !usable("stage.face_width_mm") || *width <= scene_.stage.face_width) return;
    problem(
        key, ring,
        fmt::format("must not exceed the face width, value <= {} mm", to_text(scene_.stage.face_width / units::mm)));
  }
};

}  // namespace

void check_ring(RingInput& ring, Scene& scene, std::vector<Problem>& problems) {
  RingChecker(scene, problems).check(ring);
}

}  // namespace annulus::app
