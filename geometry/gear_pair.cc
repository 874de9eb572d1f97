#include "geometry/gear_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/profile.h"

namespace annulus::geometry {

namespace {

std::string pair_name(const Gear& pinion, const Gear& wheel) {
  return fmt::format("the {} mesh of {} and {} teeth", wheel.kind() == GearKind::internal ? "internal" : "external",
                     pinion.teeth(), wheel.teeth());
}

/// What brings the start of an involute nearer to the root.
std::string root_remedy(const Gear& gear) {
  if (gear.kind() == GearKind::internal) return "root fillet factor";
  return gear.parameters().protuberance > 0 ? "root diameter, its root fillet factor or its protuberance"
                                            : "root diameter or its root fillet factor";
}

double roll_at(const Gear& gear, double radius) {
  const double base = gear.base_radius();
  return std::sqrt(std::max(0.0, (radius - base) * (radius + base)));
}

double checked_working_angle(const Gear& pinion, const Gear& wheel, double centre_distance, const PairNames& names) {
  const auto name = pair_name(pinion, wheel);
  if (pinion.kind() != GearKind::external) throw GeometryError(name + ": the first gear has to be an external one");
  // The same rack has to generate both: typed values, so equal up to rounding.
  const auto& p = pinion.parameters();
  const auto& w = wheel.parameters();
  if (std::abs(p.module - w.module) > 1e-9 * p.module || std::abs(p.pressure_angle - w.pressure_angle) > 1e-9) {
    throw GeometryError(fmt::format(
        "{}: modules {:.6g} and {:.6g} mm or pressure angles {:.6g} and {:.6g} deg differ; they have to be equal", name,
        p.module / units::mm, w.module / units::mm, p.pressure_angle / units::deg, w.pressure_angle / units::deg));
  }
  const bool internal = wheel.kind() == GearKind::internal;
  if (std::abs(w.helix_angle - (internal ? 1 : -1) * p.helix_angle) > 1e-9) {
    throw GeometryError(fmt::format("{}: helix angles {:.4f} and {:.4f} deg do not fit; they have to be equal and {}",
                                    name, p.helix_angle / units::deg, w.helix_angle / units::deg,
                                    internal ? "of the same hand (the same sign)" : "of opposite hands (signs)"));
  }
  if (internal && wheel.teeth() <= pinion.teeth()) {
    throw GeometryError(fmt::format("{}: the internal gear needs more teeth than the {}", name, names.pinion));
  }
  const double base_distance =
      internal ? wheel.base_radius() - pinion.base_radius() : wheel.base_radius() + pinion.base_radius();
  if (!(centre_distance > base_distance)) {
    throw GeometryError(
        fmt::format("{}: no working pressure angle exists at the centre distance {:.4f} mm; it has to be larger than "
                    "{:.4f} mm (reference centre distance {:.4f} mm)",
                    name, centre_distance / units::mm, base_distance / units::mm,
                    base_distance / std::cos(pinion.transverse_pressure_angle()) / units::mm));
  }
  return std::acos(base_distance / centre_distance);
}

}  // namespace

GearPair::GearPair(const Gear& planet, const Gear& wheel, double centre_distance)
    : GearPair(planet, wheel, centre_distance, wheel.kind() == GearKind::internal ? GearRole::pinion : GearRole::wheel,
               {"planet", wheel.kind() == GearKind::internal ? "ring" : "sun"}) {}

GearPair::GearPair(const Gear& pinion, const Gear& wheel, double centre_distance, GearRole driver, PairNames names)
    : pinion_(pinion),
      wheel_(wheel),
      driver_(driver),
      names_(std::move(names)),
      centre_distance_(centre_distance),
      working_pressure_angle_(checked_working_angle(pinion, wheel, centre_distance, names_)),
      normal_backlash_(0) {
  // On the working pitch circles the circular pitch has to hold both teeth; the rest is circumferential backlash.
  const double cosine = std::cos(working_pressure_angle_);
  const double pinion_pitch_radius = pinion_.base_radius() / cosine;
  const double wheel_pitch_radius = wheel_.base_radius() / cosine;
  const double along_action = pinion_.base_pitch() - cosine * (pinion_.tooth_thickness(pinion_pitch_radius) +
                                                               wheel_.tooth_thickness(wheel_pitch_radius));
  constexpr double rounding = 1e-13;  // of a difference of pitches
  if (std::abs(along_action) > rounding * pinion_.base_pitch())
    normal_backlash_ = along_action * std::cos(pinion_.base_helix_angle());
  const double module = pinion_.parameters().module;
  if (normal_backlash_ < -backlash_tolerance * module) {
    const double shift = -normal_backlash_ / (2 * module * std::sin(pinion_.parameters().pressure_angle));
    throw GeometryError(fmt::format(
        "{} has no room: its normal backlash is {:.4f} um at the centre distance {:.4f} mm; {} by {:.5f} or {} the "
        "centre distance",
        pair_name(pinion_, wheel_), normal_backlash_ / units::um, centre_distance_ / units::mm,
        internal() ? fmt::format("raise the difference of the profile shifts ({} - {})", names_.wheel, names_.pinion)
                   : "lower the sum of the profile shifts",
        shift, internal() ? "reduce" : "raise"));
  }

  const double length = centre_distance_ * std::sin(working_pressure_angle_);
  const double wheel_tip = roll_at(wheel_, wheel_.tip_form_radius());
  roll_pitch_ = pinion_.base_radius() * std::tan(working_pressure_angle_);
  roll_low_ = internal() ? wheel_tip - length : length - wheel_tip;
  roll_high_ = roll_at(pinion_, pinion_.tip_form_radius());
  check_tips();
  if (internal()) check_internal_tips();
  if (!(common_face().width > 0)) {
    const auto &p = pinion_.parameters(), &w = wheel_.parameters();
    throw GeometryError(
        fmt::format("{}: the faces do not overlap: widths of {:.4f} and {:.4f} mm, whose middles are {:.4f} mm apart "
                    "along the axis; change axial_offset",
                    pair_name(pinion_, wheel_), p.face_width / units::mm, w.face_width / units::mm,
                    std::abs(p.axial_offset - w.axial_offset) / units::mm));
  }
  if (total_contact_ratio() < 1) {
    throw GeometryError(fmt::format(
        "{} has a contact ratio of {:.4f}; at least 1 is needed: {} or reduce the working pressure angle "
        "({:.4f} deg)",
        pair_name(pinion_, wheel_), total_contact_ratio(),
        internal() ? fmt::format("enlarge the {}'s tip diameter, reduce the {}'s", names_.pinion, names_.wheel)
                   : "enlarge the tip diameters",
        working_pressure_angle_ / units::deg));
  }
}

double GearPair::back_flank_phase() const {
  const Gear& driving = driver_ == GearRole::pinion ? pinion_ : wheel_;
  const double radius = driving.base_radius() / std::cos(working_pressure_angle_);
  return driving.tooth_thickness(radius) / (radius * driving.pitch_angle());
}

GearPair::TipClearance GearPair::tip_clearance() const {
  const double side = internal() ? -1 : 1;
  return {side * (centre_distance_ - side * pinion_.tip_radius() - wheel_.root_radius()),
          side * (centre_distance_ - side * pinion_.root_radius() - wheel_.tip_radius())};
}

double GearPair::contact_ratio() const { return (roll_high_ - roll_low_) / pinion_.base_pitch(); }

CommonFace GearPair::common_face() const {
  const auto &p = pinion_.parameters(), &w = wheel_.parameters();
  const double p_low = p.axial_offset - p.face_width / 2, p_high = p.axial_offset + p.face_width / 2;
  const double w_low = w.axial_offset - w.face_width / 2, w_high = w.axial_offset + w.face_width / 2;
  const double low = std::max(p_low, w_low), high = std::min(p_high, w_high);
  // Differences of typed values: rounding is no overhang.
  const double rounding = 1e-9 * std::max(p.face_width, w.face_width);
  const auto beyond = [&](double length) { return length > rounding ? length : 0.0; };
  return {high - low, {beyond(low - p_low), beyond(p_high - high)}, {beyond(low - w_low), beyond(w_high - high)}};
}

double GearPair::overlap_ratio() const {
  const auto& p = pinion_.parameters();
  return common_face().width * std::sin(std::abs(p.helix_angle)) / (std::numbers::pi * p.module);
}

double GearPair::wheel_roll_length(double pinion_roll) const {
  const double length = centre_distance_ * std::sin(working_pressure_angle_);
  return internal() ? length + pinion_roll : length - pinion_roll;
}

double GearPair::relative_curvature(double pinion_roll) const {
  return 1 / pinion_roll + (internal() ? -1 : 1) / wheel_roll_length(pinion_roll);
}

void GearPair::check_tips() const {
  const auto name = pair_name(pinion_, wheel_);
  const auto& [pinion, wheel] = names_;
  if (roll_low_ < 0) {
    throw GeometryError(fmt::format(
        "{}: {} interference: the tip of the {} (diameter {:.4f} mm) touches {:.4f} mm beyond the start of the "
        "{}'s involute; {} its tip diameter or raise the {}'s profile shift",
        name, internal() ? "involute" : "tip", wheel, 2 * wheel_.tip_form_radius() / units::mm, -roll_low_ / units::mm,
        pinion, internal() ? "enlarge" : "reduce", pinion));
  }
  const double pinion_form = roll_at(pinion_, pinion_.form_radius());
  if (roll_low_ < pinion_form) {
    throw GeometryError(
        fmt::format("{}: tip interference: the tip of the {} (diameter {:.4f} mm) touches the {} at the diameter "
                    "{:.4f} mm, below its form diameter {:.4f} mm (start of the involute); {} that tip diameter to "
                    "{:.4f} mm, or reduce "
                    "the {}'s {}",
                    name, wheel, 2 * wheel_.tip_form_radius() / units::mm, pinion,
                    2 * std::hypot(pinion_.base_radius(), roll_low_) / units::mm, 2 * pinion_.form_radius() / units::mm,
                    internal() ? "enlarge" : "reduce",
                    2 * std::hypot(wheel_.base_radius(), wheel_roll_length(pinion_form)) / units::mm, pinion,
                    root_remedy(pinion_)));
  }
  const double wheel_roll = wheel_roll_length(roll_high_);
  const double wheel_form = roll_at(wheel_, wheel_.form_radius());
  if (internal() ? wheel_roll > wheel_form : wheel_roll < wheel_form) {
    throw GeometryError(fmt::format(
        "{}: tip interference: the tip of the {} touches the {} at roll length {:.4f} mm, its involute ends at "
        "{:.4f} mm (form diameter {:.4f} mm); reduce the {}'s tip diameter (now {:.4f} mm), or the {}'s {}",
        name, pinion, wheel, wheel_roll / units::mm, wheel_form / units::mm, 2 * wheel_.form_radius() / units::mm,
        pinion, 2 * pinion_.tip_form_radius() / units::mm, wheel, root_remedy(wheel_)));
  }
  const double a = centre_distance_;
  const double at_wheel_root =
      internal() ? wheel_.root_radius() - a - pinion_.tip_radius() : a - wheel_.root_radius() - pinion_.tip_radius();
  const double at_pinion_root =
      internal() ? wheel_.tip_radius() - a - pinion_.root_radius() : a - wheel_.tip_radius() - pinion_.root_radius();
  if (std::min(at_wheel_root, at_pinion_root) <= 0) {
    throw GeometryError(
        fmt::format("{}: a tip touches a root: clearance {:.4f} mm at the root of the {}, {:.4f} mm at the root of the "
                    "{}; reduce the tip or root diameters",
                    name, at_wheel_root / units::mm, wheel, at_pinion_root / units::mm, pinion));
  }
}

// The tip corner of the pinion's driving flank, followed in the frame of the ring: where it crosses the ring's tip
// circle the ring's tip corner has to be ahead (no interference), and inside the ring's space it has to stay clear of
// the fillet.
void GearPair::check_internal_tips() const {
  const auto name = pair_name(pinion_, wheel_);
  const double a = centre_distance_;
  const double ratio = static_cast<double>(pinion_.teeth()) / wheel_.teeth();
  // Angles behind / ahead of the line of centres at the pitch contact; the pinion's leading flank drives the trailing
  // flank of the ring tooth ahead of it.
  const double working = involute(working_pressure_angle_);
  const double pinion_corner = involute(std::acos(pinion_.base_radius() / pinion_.tip_radius())) - working;
  const double ring_corner = working - involute(std::acos(wheel_.base_radius() / wheel_.tip_radius()));
  const double tip = pinion_.tip_radius();
  const double crossing = (wheel_.tip_radius() * wheel_.tip_radius() - a * a - tip * tip) / (2 * a * tip);
  if (crossing > -1 && crossing < 1) {
    const double pinion_angle = std::acos(crossing);
    const double ring_angle = std::atan2(tip * std::sin(pinion_angle), a + tip * std::cos(pinion_angle));
    const double ahead = ring_corner + (pinion_angle + pinion_corner) * ratio - ring_angle;
    if (ahead < 0) {
      throw GeometryError(
          fmt::format("{2}: the tips interfere by {3:.4f} mm where the {0}'s teeth leave the {1} (too small a "
                      "difference of teeth); reduce the {0}'s tip diameter or enlarge the {1}'s",
                      names_.pinion, names_.wheel, name, -ahead * wheel_.tip_radius() / units::mm));
    }
  }

  const RootFillet fillet(wheel_);
  const ToothProfile ring(wheel_);
  const double wheel_pitch_radius = wheel_.base_radius() / std::cos(working_pressure_angle_);
  const double half_tooth = wheel_.tooth_half_angle(wheel_pitch_radius);
  constexpr int samples = 200;  // over the pinion's turn inside the ring; the fillet spans some ten of them
  for (int i = 0; i <= samples; ++i) {
    const double pinion_angle = pinion_.pitch_angle() * 2 * (2.0 * i / samples - 1);
    const double radius = std::hypot(a + tip * std::cos(pinion_angle), tip * std::sin(pinion_angle));
    if (radius <= wheel_.form_radius()) continue;
    const double turned = (pinion_angle + pinion_corner) * ratio;
    const double absolute = std::atan2(tip * std::sin(pinion_angle), a + tip * std::cos(pinion_angle));
    // Angle behind the centre of the ring tooth ahead: mirrored, that is the leading side of tooth 0.
    const double behind = half_tooth + turned - absolute;
    const Eigen::Vector2d corner(radius * std::cos(behind), radius * std::sin(behind));
    const double t = fillet.nearest(corner);
    const Eigen::Vector2d tangent = fillet.tangent(t);
    // Material lies on the right of the fillet walked from tip to root of an internal tooth.
    const double depth = (corner - fillet.point(t)).dot(Eigen::Vector2d(tangent.y(), -tangent.x()));
    if (t > 0 && t < 1 && depth > 1e-9 * pinion_.parameters().module) {
      throw GeometryError(
          fmt::format("{2}: the {0}'s tip corner cuts {3:.4f} um into the root fillet of the {1}; reduce the "
                      "{0}'s tip diameter or the {1}'s root fillet factor",
                      names_.pinion, names_.wheel, name, depth / units::um));
    }
  }
}

}  // namespace annulus::geometry
