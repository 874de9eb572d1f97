#include "fem/problem/support_sites.h"

#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

SupportSites pin_sites(const PinHeld& pins, const SupportedRing& ring) {
  if (pins.angles.empty()) throw InputError("a pinned ring needs at least one pin");
  if (pins.angles.size() == 1 && !pins.housing_clearance)
    throw InputError(
        "a ring on one pin turns about it and cannot be in equilibrium without a housing bore around it: give the "
        "housing's clearance, or a second pin");
  const double local = derived_pin_stiffness(ring.material, ring.face_width);
  SupportDirection radial, tangential;
  radial.unilateral = pins.unilateral;
  radial.clearance = pins.clearance;
  radial.stiffness = pins.radial_stiffness.value_or(local);
  if (!pins.radial_stiffness)
    radial.end_stiffness = pin_span_stiffness(ring.material, pins.pin_diameter, pins.free_span);
  tangential = radial;
  tangential.inward = 0;
  tangential.counter_clockwise = 1;
  tangential.unilateral = false;
  tangential.clearance = 0;
  if (pins.tangential_stiffness) {
    tangential.stiffness = *pins.tangential_stiffness;
    tangential.end_stiffness = std::numeric_limits<double>::infinity();
  }
  SupportSites result;
  result.pins = static_cast<int>(pins.angles.size());
  for (const double angle : pins.angles)
    result.sites.push_back({-angle, pins.pin_diameter / 2 / ring.outside_radius, true, {radial, tangential}});
  if (pins.housing_clearance) {
    SupportDirection bore;
    bore.clearance = *pins.housing_clearance;
    bore.stiffness = local;  // the width of a squeezed prism over its height does not depend on its size
    const double pitch = 2 * M_PI / ring.teeth;
    for (int tooth = 0; tooth < ring.teeth; ++tooth) result.sites.push_back({-tooth * pitch, pitch / 2, false, {bore}});
  }
  return result;
}

SupportSites spline_sites(const SplineHeld& spline, const SupportedRing& ring) {
  if (spline.teeth < 3) throw InputError("a splined ring needs at least three spline teeth");
  SupportSites result;
  result.pins = spline.teeth;
  const double pitch = 2 * M_PI / spline.teeth;
  SupportDirection clockwise, counter_clockwise;
  clockwise.clearance = counter_clockwise.clearance = spline.clearance;
  clockwise.stiffness = counter_clockwise.stiffness =
      spline.flank_stiffness.value_or(derived_spline_stiffness(ring.material, ring.face_width));
  clockwise.inward = counter_clockwise.inward = std::sin(spline.flank_angle);
  counter_clockwise.counter_clockwise = std::cos(spline.flank_angle);
  clockwise.counter_clockwise = -std::cos(spline.flank_angle);
  for (int tooth = 0; tooth < spline.teeth; ++tooth)
    result.sites.push_back(
        {-(spline.first_tooth_angle + tooth * pitch), pitch / 4, false, {counter_clockwise, clockwise}});
  return result;
}

double derived_pin_stiffness(const Material& material, double length) {
  return M_PI * material.youngs_modulus * length / (4 * (1 - material.poisson_ratio * material.poisson_ratio));
}

double pin_span_stiffness(const Material& material, double diameter, double span) {
  if (span <= 0) return std::numeric_limits<double>::infinity();
  const double E = material.youngs_modulus, nu = material.poisson_ratio;
  const double second_moment = M_PI * std::pow(diameter, 4) / 64, area = M_PI * diameter * diameter / 4;
  const double kappa = 6 * (1 + nu) / (7 + 6 * nu), shear_modulus = E / (2 * (1 + nu));
  return 2 / (std::pow(span, 3) / (12 * E * second_moment) + span / (kappa * shear_modulus * area));
}

double derived_spline_stiffness(const Material& material, double width) {
  constexpr double of_steel = 14e9, steel = 206e9;  // Pa
  return of_steel * material.youngs_modulus / steel * width;
}

}  // namespace annulus::fem
