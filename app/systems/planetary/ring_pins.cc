#include "app/systems/planetary/ring_pins.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class PinChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void check(RingInput& ring) {
    const bool equal = given("ring.pins", ring.name), listed = given("ring.pin_angles_deg", ring.name);
    if (listed && !equal && usable("ring.pin_angles_deg", ring.name)) listed_pins(ring);
    if (equal && !listed && ring.pins) equal_pins(ring);
    if (ring.pin_count() == 1) rest_in_bore(ring);
  }

 private:
  /// Gives the only pin of a ring a bore of the housing without play, unless the scene declares one.
  void rest_in_bore(RingInput& ring) {
    for (auto& input : scene_.inputs) {
      if (input.key != "ring.housing_clearance_um" || input.variant != ring.name || input.origin == Origin::scene)
        continue;
      input.value = 0.0;
      input.note = "a single pin cannot hold the ring alone: it rests in the bore of the housing";
      ring.housing_clearance = 0;
    }
  }

  void equal_pins(const RingInput& ring) {
    const auto radius = known_outside(scene_, ring);
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
    const auto radius = known_outside(scene_, ring);
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
};

}  // namespace

void declare_pins(const StructureKeys& keys) {
  keys.optional("pins", &RingInput::pins, "Number of equally spaced pins or bolts.")
      .from(1, 2000)
      .absent("pin_angles_deg lists them");
  keys.optional("pin_angles_deg", &RingInput::pin_angles,
                "Angular position of every pin, counter-clockwise from the centre of tooth 0.")
      .from(-360, 360)
      .longest(2000)
      .instead_of({"pins"})
      .absent("equally spaced");
  keys.optional("first_pin_angle_deg", &RingInput::first_pin_angle,
                "Angular position of the first of equally spaced pins, from the centre of tooth 0.")
      .from(-360, 360)
      .only_if(given("pins"), "pin_angles_deg positions every pin")
      .fallback(0.0, "behind tooth 0");
  keys.needed("pin_diameter_mm", &RingInput::pin_diameter, "Diameter of a pin or bolt.").above(0, 1000);
  keys.ring.key("pin_clearance_um", &RingInput::pin_clearance, "Radial play of a pin.")
      .from(0, 1e4)
      .only_if(is("structure", {"pinned"}))
      .fallback(0.0, "no play");
  keys.optional("pin_radial_stiffness_N_per_m", &RingInput::pin_radial_stiffness,
                "Radial stiffness of one pin or bolt.")
      .above(0, 1e14)
      .absent("derived from the pin");
  keys.optional("pin_tangential_stiffness_N_per_m", &RingInput::pin_tangential_stiffness,
                "Tangential stiffness of one pin or bolt.")
      .above(0, 1e14)
      .absent("equal to the radial stiffness");
  keys.optional("pin_free_span_mm", &RingInput::pin_free_span,
                "Length of pin between ring and housing, where it bends and shears.")
      .from(0, 1000)
      .fallback(0.0, "no bending of the pin");
  keys.optional("housing_clearance_um", &RingInput::housing_clearance,
                "Radial play of the rim in a rigid housing bore, on which it can rest.")
      .from(0, 1e4)
      .absent("no bore; 0 with a single pin, because one pin cannot hold the ring alone");
}

void check_pins(RingInput& ring, Scene& scene, std::vector<Problem>& problems) {
  PinChecker(scene, problems).check(ring);
}

fem::PinHeld on_pins(const RingInput& ring, PinContact contact) {
  return {.angles = ring.pins ? fem::equal_angles(*ring.pins, ring.first_pin_angle.value_or(0)) : ring.pin_angles,
          .pin_diameter = ring.pin_diameter.value_or(0),
          .clearance = ring.pin_clearance.value_or(0),
          .free_span = ring.pin_free_span.value_or(0),
          .radial_stiffness = ring.pin_radial_stiffness,
          .tangential_stiffness = ring.pin_tangential_stiffness,
          .housing_clearance = ring.housing_clearance,
          .unilateral = contact == PinContact::unilateral};
}

}  // namespace annulus::app
