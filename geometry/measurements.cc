#include "geometry/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/units.h"

namespace annulus::geometry {

namespace {

/// The transverse section and the signs of a kind of gear, before the gear itself can be made.
struct Section {
  double transverse_angle, base_radius, base_helix, sign;

  explicit Section(const GearParameters& p)
      : transverse_angle(std::atan(std::tan(p.pressure_angle) / std::cos(p.helix_angle))),
        base_radius(p.module * p.teeth / (2 * std::cos(p.helix_angle)) * std::cos(transverse_angle)),
        base_helix(std::asin(std::sin(p.helix_angle) * std::cos(p.pressure_angle))),
        sign(p.kind == GearKind::external ? 1 : -1) {}
};

/// Half the angle of a space on its base circle without profile shift, continued there for internal gears, rad; the
/// shift takes 2 x tan(alpha_n) / z of it from an external gear and adds it to an internal one.
double space_without_shift(const GearParameters& p, const Section& s) {
  return std::numbers::pi / (2 * p.teeth) - s.sign * involute(s.transverse_angle);
}

double of_shift(const GearParameters& p) { return 2 * std::tan(p.pressure_angle) / p.teeth; }

/// Angle by which the flank normal through a pin's centre stands off the middle of the space, rad.
double pin_angle(double pin_diameter, const Section& s) {
  return pin_diameter / (2 * s.base_radius * std::cos(s.base_helix));
}

/// Radius of the pins' centres over that of the dimension: 1, or for an odd number of teeth the cosine of half a pitch
/// off the diameter.
double off_diameter(int teeth) { return teeth % 2 == 0 ? 1 : std::cos(std::numbers::pi / (2 * teeth)); }

}  // namespace

int usual_span_teeth(const Gear& gear) {
  const double middle = (gear.tip_form_radius() + gear.form_radius()) / 2;
  // In the transverse section the tangent touches both flanks at half its length, W / (2 cos(beta_b)).
  int best = 1;
  double nearest = 0;
  for (int k = 1; k <= std::max(1, gear.teeth() / 2); ++k) {
    const double half = gear.base_tangent_length(k) * std::cos(gear.base_helix_angle()) / 2;
    const double distance = std::abs(std::hypot(gear.base_radius(), half) - middle);
    if (k > 1 && distance > nearest) break;
    best = k, nearest = distance;
  }
  return best;
}

double usual_pin_diameter(const Gear& gear) {
  const auto& p = gear.parameters();
  const Section s(p);
  const double radius = gear.reference_radius() + p.profile_shift * p.module;
  if (radius <= gear.base_radius())
    throw GeometryError(
        fmt::format("the gear with {} teeth has no pins that touch its involute at the diameter "
                    "{:.4f} mm, inside its base circle",
                    p.teeth, 2 * radius / units::mm));
  // The flank touches at `radius`; its normal is tangent to the base circle and meets the middle of the space.
  const double angle = std::acos(gear.base_radius() / radius);
  const double half_space = std::numbers::pi / p.teeth - gear.tooth_half_angle(radius);
  const double to_centre = std::tan(angle + s.sign * half_space) - std::tan(angle);
  return 2 * s.sign * to_centre * gear.base_radius() * std::cos(s.base_helix);
}

double dimension_over_pins(const Gear& gear, double pin_diameter) {
  const auto& p = gear.parameters();
  const Section s(p);
  const double half_space = space_without_shift(p, s) - s.sign * of_shift(p) * p.profile_shift;
  const double inv = s.sign * (pin_angle(pin_diameter, s) - half_space);
  const auto refuse = [&] {
    throw GeometryError(fmt::format("pins of {:.4f} mm do not touch the flanks of the gear with {} teeth",
                                    pin_diameter / units::mm, p.teeth));
  };
  if (!(pin_diameter > 0) || !(inv > 0)) refuse();
  const double angle = inverse_involute(inv);
  const double centre = gear.base_radius() / std::cos(angle);
  // Of the flank: the pin's radius back along the normal.
  const double roll = gear.base_radius() * std::tan(angle) - s.sign * pin_diameter / (2 * std::cos(s.base_helix));
  const double touch = std::hypot(gear.base_radius(), roll);
  const double low = std::min(gear.form_radius(), gear.tip_form_radius()),
               high = std::max(gear.form_radius(), gear.tip_form_radius());
  if (roll < 0 || touch < low || touch > high) refuse();
  return 2 * centre * off_diameter(p.teeth) + s.sign * pin_diameter;
}

double normal_tooth_thickness(const Gear& gear) {
  return gear.tooth_thickness(gear.reference_radius()) * std::cos(gear.parameters().helix_angle);
}

double shift_from_span(const GearParameters& gear, int teeth, double length) {
  const Section s(gear);
  const double without = gear.module * std::cos(gear.pressure_angle) *
                         (std::numbers::pi * (teeth - 0.5) + gear.teeth * involute(s.transverse_angle));
  return (length - without) / (2 * gear.module * std::sin(gear.pressure_angle));
}

double shift_from_pins(const GearParameters& gear, double pin_diameter, double dimension) {
  const Section s(gear);
  const double centre = (dimension - s.sign * pin_diameter) / (2 * off_diameter(gear.teeth));
  if (!(centre > s.base_radius))
    throw GeometryError(
        fmt::format("the centres of the pins would be {:.4f} mm from the axis, inside the base circle of radius "
                    "{:.4f} mm",
                    centre / units::mm, s.base_radius / units::mm));
  const double inv = involute(std::acos(s.base_radius / centre));
  // inv = sign (pin angle - half space), half space = without shift - sign of_shift x.
  return (inv - s.sign * (pin_angle(pin_diameter, s) - space_without_shift(gear, s))) / of_shift(gear);
}

double shift_from_tip_diameter(const GearParameters& gear, double diameter) {
  const Section s(gear);
  return (diameter / 2 - s.base_radius / std::cos(s.transverse_angle)) / gear.module - s.sign;
}

double shift_from_root_diameter(const GearParameters& gear, double diameter) {
  const Section s(gear);
  return (diameter / 2 - s.base_radius / std::cos(s.transverse_angle)) / gear.module + 1.25 * s.sign;
}

double shifts_from_centre_distance(const GearParameters& pinion, const GearParameters& wheel, double centre_distance,
                                   double normal_backlash) {
  const Section first(pinion), second(wheel);
  const double base_distance = second.sign * first.base_radius + second.base_radius;
  if (!(centre_distance > base_distance))
    throw GeometryError(
        fmt::format("no working pressure angle exists at the centre distance {:.4f} mm; it has to be "
                    "larger than {:.4f} mm",
                    centre_distance / units::mm, base_distance / units::mm));
  const double working = std::acos(base_distance / centre_distance);
  const double without =
      (second.sign * pinion.teeth + wheel.teeth) * (involute(working) - involute(first.transverse_angle));
  // A shift moves the flanks of a gear by x m_n sin(alpha_n) along their normal, on both sides.
  const double play = normal_backlash / (pinion.module * std::cos(pinion.pressure_angle));
  return (without - second.sign * play) / (2 * std::tan(pinion.pressure_angle));
}

SpecificSliding specific_sliding(const GearPair& pair) {
  const double ratio = static_cast<double>(pair.pinion().teeth()) / pair.wheel().teeth();
  const auto of_pinion = [&](double roll) { return 1 - pair.wheel_roll_length(roll) * ratio / roll; };
  const auto of_wheel = [&](double roll) { return 1 - roll / (pair.wheel_roll_length(roll) * ratio); };
  const double low = pair.roll_length_low(), high = pair.roll_length_high();
  return {of_pinion(low), of_wheel(low), of_pinion(high), of_wheel(high)};
}

}  // namespace annulus::geometry
