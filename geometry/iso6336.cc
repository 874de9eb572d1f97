#include "geometry/iso6336.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/units.h"

namespace annulus::geometry {

namespace {

void require_spur(const Gear& gear) {
  if (gear.helix_angle() != 0)
    throw GeometryError(fmt::format("the ISO 6336 formulas here are for spur gears; the helix angle is {:.4f} deg",
                                    gear.helix_angle() / units::deg));
}

double sign_of(const Gear& gear) { return gear.kind() == GearKind::internal ? -1 : 1; }

/// z of the standard: negative for an internal gear.
double iso_teeth(const Gear& gear) { return sign_of(gear) * gear.teeth(); }

double iso_shift(const Gear& gear) { return sign_of(gear) * gear.parameters().profile_shift; }

/// h_fP / m of the basic rack that makes the root diameter.
double dedendum(const Gear& gear) {
  const double depth = sign_of(gear) * (gear.reference_radius() - gear.root_radius());
  return depth / gear.parameters().module + iso_shift(gear);
}

/// theta = 2 G / z tan(theta) - H [ISO6336-3, 6.2.2].
double tangent_angle(double g, double teeth, double h, double start) {
  double theta = start;
  for (int i = 0; i < 100; ++i) {
    const double next = 2 * g / teeth * std::tan(theta) - h;
    const bool found = std::abs(next - theta) <= 1e-14;
    theta = next;
    if (found && std::abs(theta) < std::numbers::pi / 2) return theta;
  }
  throw GeometryError(
      fmt::format("ISO 6336-3 finds no critical section in the root of the gear with {} teeth: too few teeth or too "
                  "large a dedendum",
                  std::abs(teeth)));
}

}  // namespace

double gear_blank_factor(double web_thickness, double face_width, double rim_thickness_in_modules) {
  const double web = std::clamp(web_thickness / face_width, 0.2, 1.2);
  return 1 + std::log(web) / (5 * std::exp(std::max(rim_thickness_in_modules, 1.0) / 5));
}

Iso6336Stiffness iso_6336_stiffness(const GearPair& pair, const Iso6336Bodies& bodies) {
  require_spur(pair.pinion());
  const bool swapped = pair.wheel().teeth() < pair.pinion().teeth();
  const Gear& first = swapped ? pair.wheel() : pair.pinion();
  const Gear& second = swapped ? pair.pinion() : pair.wheel();
  const double z1 = first.teeth(), x1 = iso_shift(first), x2 = iso_shift(second);
  const double inverse_z2 = pair.internal() ? 0 : 1.0 / second.teeth();
  const double q = 0.04723 + 0.15551 / z1 + 0.25791 * inverse_z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 -
                   0.24188 * x2 * inverse_z2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;  // mm um / N
  const double mean_dedendum = (dedendum(first) + dedendum(second)) / 2;
  const double basic_rack =
      (1 + 0.5 * (1.2 - mean_dedendum)) * (1 - 0.02 * (20 - first.parameters().pressure_angle / units::deg));
  Iso6336Stiffness stiffness;
  stiffness.theoretical = basic_rack / q * 1e9 * bodies.youngs_modulus / 206e9;
  stiffness.single = stiffness.theoretical * bodies.correction * bodies.gear_blank;
  stiffness.mesh = stiffness.single * mesh_over_single_stiffness(pair.contact_ratio());
  stiffness.mesh_beta = 0.85 * stiffness.mesh;
  return stiffness;
}

double contact_ratio_factor(const GearPair& pair) {
  require_spur(pair.pinion());
  return std::sqrt((4 - pair.contact_ratio()) / 3);
}

double nominal_flank_pressure(const GearPair& pair, double tangential_force, double contact_modulus) {
  const double working = pair.working_pressure_angle(), cosine = std::cos(pair.pinion().parameters().pressure_angle);
  const double zone = std::sqrt(2 * std::cos(working) / (cosine * cosine * std::sin(working)));
  const double elasticity = std::sqrt(contact_modulus / std::numbers::pi);
  const double u = iso_teeth(pair.wheel()) / pair.pinion().teeth();
  const double diameter = 2 * pair.pinion().reference_radius();
  return zone * elasticity * contact_ratio_factor(pair) *
         std::sqrt(tangential_force / (diameter * pair.common_face().width) * (u + 1) / u);
}

RootSection root_section(const GearPair& pair, const Gear& gear, const std::optional<PinionCutter>& cutter) {
  require_spur(gear);
  const bool internal = gear.kind() == GearKind::internal;
  if (internal != cutter.has_value())
    throw GeometryError(internal ? "the root of an internal gear needs the pinion-type cutter that makes it"
                                 : "the root of an external gear is made by its basic rack, not by a cutter");
  const auto& p = gear.parameters();
  const double alpha = p.pressure_angle, z = iso_teeth(gear), x = iso_shift(gear);
  const double h_fp = dedendum(gear);  // lengths in modules from here
  double rho_fp = p.root_fillet_factor;
  if (cutter)
    rho_fp = cutter->tip_radius + std::pow(cutter->profile_shift + h_fp - cutter->tip_radius, 1.95) /
                                      (3.156 * std::pow(1.036, cutter->teeth));

  const double e = std::numbers::pi / 4 - h_fp * std::tan(alpha) + p.protuberance / p.module / std::cos(alpha) -
                   (1 - std::sin(alpha)) * rho_fp / std::cos(alpha);
  const double g = rho_fp - h_fp + x;
  const double tangent = internal ? std::numbers::pi / 6 : std::numbers::pi / 3;
  const double theta = tangent_angle(g, z, 2 / z * (std::numbers::pi / 2 - e) - tangent,
                                     internal ? std::numbers::pi / 3 : std::numbers::pi / 6);
  const double notch = g / std::cos(theta) - rho_fp;
  const double chord = z * std::sin(tangent - theta) + (internal ? 1 : std::numbers::sqrt3) * notch;
  const double radius =
      rho_fp + 2 * g * g / (std::cos(theta) * (std::abs(z) * std::cos(theta) * std::cos(theta) - 2 * g));

  // Outer point of single pair contact: epsilon - 1 base pitches from the tip towards the root.
  const double base = gear.base_radius() / p.module, tip = gear.tip_form_radius() / p.module;
  const double roll = std::sqrt(tip * tip - base * base) -
                      sign_of(gear) * std::numbers::pi * std::cos(alpha) * (pair.contact_ratio() - 1);
  const double load_radius = std::hypot(roll, base);
  const double load_pressure_angle = std::acos(base / load_radius);
  const double gamma =
      (std::numbers::pi / 2 + 2 * std::tan(alpha) * x) / z + involute(alpha) - involute(load_pressure_angle);
  const double load_angle = load_pressure_angle - gamma;
  const double lever = ((std::cos(gamma) - std::sin(gamma) * std::tan(load_angle)) * 2 * sign_of(gear) * load_radius -
                        z * std::cos(tangent - theta) - (internal ? std::numbers::sqrt3 : 1) * notch) /
                       2;

  const double slenderness = chord / lever, notch_parameter = chord / (2 * radius);
  const CommonFace face = pair.common_face();
  const auto& pinion = pair.pinion().parameters();
  const bool as_pinion = p.face_width == pinion.face_width && p.axial_offset == pinion.axial_offset;
  const Overhang& beyond = as_pinion ? face.pinion : face.wheel;
  RootSection root;
  root.face_width = face.width + std::min(beyond.below, p.module) + std::min(beyond.above, p.module);
  root.chord = chord * p.module;
  root.lever = lever * p.module;
  root.fillet_radius = radius * p.module;
  root.load_angle = load_angle;
  root.form_factor = 6 * lever * std::cos(load_angle) / (chord * chord * std::cos(alpha));
  root.stress_correction = (1.2 + 0.13 * slenderness) * std::pow(notch_parameter, 1 / (1.21 + 2.3 / slenderness));
  return root;
}

double nominal_root_stress(const Gear& gear, const RootSection& root, double tangential_force) {
  const auto& p = gear.parameters();
  return tangential_force / (root.face_width * p.module) * root.form_factor * root.stress_correction;
}

double rim_thickness_factor(const Gear& gear, double rim) {
  const auto& p = gear.parameters();
  if (gear.kind() == GearKind::internal) {
    const double in_modules = std::max(1.75, rim / p.module);
    return in_modules >= 3.5 ? 1 : 1.15 * std::log(8.324 / in_modules);
  }
  const double height = gear.tip_radius() - gear.root_radius(), in_heights = std::max(0.5, rim / height);
  return in_heights >= 1.2 ? 1 : 1.6 * std::log(2.242 / in_heights);
}

}  // namespace annulus::geometry
