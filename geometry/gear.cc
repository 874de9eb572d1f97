#include "geometry/gear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/flank_topography.h"
#include "geometry/root_fillet.h"

namespace annulus::geometry {

namespace {

constexpr double min_tip_thickness = 0.2;  // modules; the usual lower limit of the normal tip thickness
constexpr double max_helix_angle = 45 * units::deg;

std::string gear_name(const GearParameters& p) {
  return fmt::format("the {} gear with {} teeth", p.kind == GearKind::external ? "external" : "internal", p.teeth);
}

void require_gear(bool condition, const GearParameters& p, const std::string& message) {
  if (!condition) throw GeometryError(gear_name(p) + " " + message);
}

void check_inputs(const GearParameters& p) {
  require_gear(p.teeth >= 5, p, "has too few teeth; at least 5 are needed");
  require_gear(std::isfinite(p.module), p, "has a module that is not a finite number");
  require_gear(p.module > 0, p, fmt::format("has a module of {:.6g} mm; it has to be positive", p.module / units::mm));
  require_gear(
      p.pressure_angle >= 10 * units::deg && p.pressure_angle <= 35 * units::deg, p,
      fmt::format("has a pressure angle of {:.3f} deg; 10 to 35 deg are supported", p.pressure_angle / units::deg));
  require_gear(std::abs(p.helix_angle) <= max_helix_angle, p,
               fmt::format("has a helix angle of {:.3f} deg; -45 (left hand) to 45 deg (right hand) are supported",
                           p.helix_angle / units::deg));
  require_gear(std::isfinite(p.face_width), p, "has a face width that is not a finite number");
  require_gear(p.face_width > 0, p,
               fmt::format("has a face width of {:.6g} mm; it has to be positive", p.face_width / units::mm));
  require_gear(std::isfinite(p.profile_shift), p, "has a profile shift that is not a finite number");
  require_gear(p.root_fillet_factor >= RootFillet::min_radius, p,
               fmt::format("has a root fillet factor of {}; at least {} is needed", p.root_fillet_factor,
                           RootFillet::min_radius));
  require_gear(p.tip_relief >= 0 && p.tip_relief_length >= 0 && p.profile_crowning >= 0 && p.lead_crowning >= 0, p,
               "has a negative tip relief, tip relief length, profile crowning or lead crowning; they are material "
               "removed, >= 0");
  require_gear(std::isfinite(p.lead_slope) && std::isfinite(p.profile_slope), p,
               "has a lead slope or a profile slope that is not a finite number");
  require_gear(p.tip_chamfer >= 0 && std::isfinite(p.tip_chamfer), p, "has a negative tip chamfer");
  require_gear(
      p.tip_relief == 0 || p.tip_relief_length > 0, p,
      fmt::format("has a tip relief of {:.6g} um but no tip relief length; give the length along the line of action",
                  p.tip_relief / units::um));
}

void check_tip(const Gear& gear) {
  const auto& p = gear.parameters();
  const double sign = p.kind == GearKind::external ? 1 : -1;
  require_gear(sign * (gear.tip_radius() - gear.root_radius()) > 0, p,
               fmt::format("has its tip diameter {:.4f} mm on the wrong side of its root diameter {:.4f} mm",
                           2 * gear.tip_radius() / units::mm, 2 * gear.root_radius() / units::mm));
  require_gear(
      gear.tip_radius() > gear.base_radius(), p,
      fmt::format("has its tip circle (diameter {:.4f} mm) inside its base circle ({:.4f} mm): no involute there; "
                  "change the tip diameter, the profile shift or the number of teeth",
                  2 * gear.tip_radius() / units::mm, 2 * gear.base_radius() / units::mm));
  const double thickness = gear.tooth_thickness(gear.tip_radius()) * std::cos(gear.helix_angle_at(gear.tip_radius()));
  require_gear(
      thickness >= min_tip_thickness * p.module, p,
      fmt::format("has pointed teeth: {:.4f} mm thick at the tip (normal section), at least {} modules = {:.4f} mm are "
                  "needed; reduce the profile shift or bring the tip diameter nearer to the root",
                  thickness / units::mm, min_tip_thickness, min_tip_thickness * p.module / units::mm));
  if (p.tip_chamfer == 0) return;
  const double end = gear.tip_form_radius();
  require_gear(
      end > gear.base_radius() && gear.tooth_thickness(end) > 2 * p.tip_chamfer, p,
      fmt::format("has a tip chamfer of {:.4f} mm, which leaves no tip; reduce it", p.tip_chamfer / units::mm));
}

}  // namespace

double involute(double angle) { return std::tan(angle) - angle; }

double inverse_involute(double value) {
  require(value >= 0 && std::isfinite(value), "inverse_involute needs a finite value >= 0");
  // inv is convex and increasing: Newton from above converges monotonically. The start is above the root because
  // inv(a) >= a^3/3, and for large values because inv(a) > tan(a) - pi/2.
  double angle = value < 1 ? std::cbrt(3 * value) : std::atan(value + std::numbers::pi / 2);
  for (int i = 0; i < 60 && angle > 0; ++i) {
    const double tangent = std::tan(angle);
    const double step = (tangent - angle - value) / (tangent * tangent);
    angle -= step;
    if (std::abs(step) <= 1e-16 * angle) break;
  }
  return angle;
}

bool measured(const GearParameters& p) { return p.leading_topography || p.trailing_topography; }

bool modified(const GearParameters& p) {
  return p.tip_relief != 0 || p.profile_crowning != 0 || p.profile_slope != 0 || modified_along_face(p) || measured(p);
}

bool modified_along_face(const GearParameters& p) {
  const auto varies = [](const auto& topography) { return topography && topography->varies_along_face(); };
  return p.lead_crowning != 0 || p.lead_slope != 0 || varies(p.leading_topography) || varies(p.trailing_topography);
}

Gear::Gear(const GearParameters& parameters) : p_(parameters) {
  check_inputs(p_);
  transverse_module_ = p_.module / std::cos(p_.helix_angle);
  transverse_pressure_angle_ = std::atan(std::tan(p_.pressure_angle) / std::cos(p_.helix_angle));
  base_radius_ = reference_radius() * std::cos(transverse_pressure_angle_);
  check_tip(*this);
  const RootFillet fillet(*this);
  form_radius_ = std::hypot(base_radius(), fillet.form_roll());
  undercut_ = fillet.undercut();
  const double sign = kind() == GearKind::external ? 1 : -1;
  require_gear(
      sign * (tip_form_radius() - form_radius_) > 0, p_,
      fmt::format("has no usable flank: its root fillet reaches to the diameter {:.4f} mm, the flank ends at {:.4f} "
                  "mm; reduce the root fillet factor or the tip chamfer, or move tip and root apart",
                  2 * form_radius_ / units::mm, 2 * tip_form_radius() / units::mm));
  const double usable = std::abs(std::sqrt(tip_form_radius() * tip_form_radius() - base_radius() * base_radius()) -
                                 std::sqrt(form_radius_ * form_radius_ - base_radius() * base_radius()));
  require_gear(
      p_.tip_relief_length <= usable, p_,
      fmt::format("has a tip relief length of {:.4f} mm, longer than its flank ({:.4f} mm along the line of action)",
                  p_.tip_relief_length / units::mm, usable / units::mm));
}

double Gear::pitch_angle() const { return 2 * std::numbers::pi / p_.teeth; }
double Gear::helix_angle_at(double radius) const {
  return std::atan(std::tan(p_.helix_angle) * radius / reference_radius());
}
double Gear::base_helix_angle() const { return helix_angle_at(base_radius()); }
double Gear::base_pitch() const { return pitch_angle() * base_radius(); }

double Gear::tip_radius() const {
  if (p_.tip_diameter) return *p_.tip_diameter / 2;
  const double r = reference_radius();
  return kind() == GearKind::external ? r + p_.module * (1 + p_.profile_shift) : r - p_.module * (1 - p_.profile_shift);
}

double Gear::tip_form_radius() const { return tip_radius() + (kind() == GearKind::external ? -1 : 1) * p_.tip_chamfer; }

double Gear::root_radius() const {
  if (p_.root_diameter) return *p_.root_diameter / 2;
  const double r = reference_radius();
  return kind() == GearKind::external ? r - p_.module * (1.25 - p_.profile_shift)
                                      : r + p_.module * (1.25 + p_.profile_shift);
}

double Gear::tooth_half_angle(double radius) const {
  require(radius >= base_radius() * (1 - 1e-12), "tooth_half_angle is asked inside the base circle");
  const double roll = std::sqrt(std::max(0.0, radius * radius - base_radius() * base_radius())) / base_radius();
  const double inv = roll - std::atan(roll);
  // The material of an internal tooth is what the space (the shape of an external tooth of the same x) leaves over. On
  // the reference circle the normal thickness m_n (pi / 2 + 2 x tan(alpha_n)) covers this share of m_t z / 2:
  const double sign = kind() == GearKind::external ? 1 : -1;
  const double at_reference =
      (std::numbers::pi / 2 + sign * 2 * p_.profile_shift * std::tan(p_.pressure_angle)) / p_.teeth;
  return at_reference + sign * (involute(transverse_pressure_angle()) - inv);
}

double Gear::base_tangent_length(int k) const {
  require(k >= 1, "base tangent length over less than one tooth");
  const double alpha = p_.pressure_angle;
  return p_.module * std::cos(alpha) *
             (std::numbers::pi * (k - 0.5) + p_.teeth * involute(transverse_pressure_angle())) +
         2 * p_.profile_shift * p_.module * std::sin(alpha);
}

}  // namespace annulus::geometry
