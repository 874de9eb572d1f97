#include "fem/closed_form/ring_supports.h"

#include <cmath>

#include "core/errors.h"
#include "fem/mesh_bodies.h"

namespace annulus::fem {
namespace {

double pin_stiffness(const PinHeld& pins, const Material& material, double width) {
  const double d = pins.pin_diameter, area = M_PI * d * d / 4, inertia = M_PI * std::pow(d, 4) / 64;
  const double e = material.youngs_modulus, nu = material.poisson_ratio, kappa = 6 * (1 + nu) / (7 + 6 * nu);
  const double span = pins.free_span, shear_modulus = e / (2 * (1 + nu));
  const double spans = (std::pow(span, 3) / (12 * e * inertia) + span / (kappa * shear_modulus * area)) / 2;
  return 1 / (1 / derived_pin_stiffness(material, width) + spans);
}

std::vector<RingSupport> pin_supports(const PinHeld& pins, double outside_radius, double width, int ring_teeth,
                                      const Material& material, double sense) {
  if (pins.angles.empty() || (pins.angles.size() == 1 && !pins.housing_clearance))
    throw InputError("a ring on fewer than two pins turns about its pin: give at least two, or a housing bore");
  const double radial = pins.radial_stiffness.value_or(pin_stiffness(pins, material, width));
  const double tangential = pins.tangential_stiffness.value_or(radial);
  const double half_angle = pins.pin_diameter / 2 / outside_radius;
  std::vector<RingSupport> supports;
  for (const double angle : pins.angles) {
    supports.push_back({sense * angle, half_angle, Spread::parabolic, 1, 0, radial, pins.clearance, pins.unilateral});
    supports.push_back({sense * angle, half_angle, Spread::parabolic, 0, 1, tangential, 0, false});
  }
  if (pins.housing_clearance)  // squeezed like a pin: width over height of a prism does not depend on its size
    for (int i = 0; i < ring_teeth; ++i)
      supports.push_back({2 * M_PI * i / ring_teeth, M_PI / ring_teeth, Spread::uniform, 1, 0,
                          derived_pin_stiffness(material, width), *pins.housing_clearance, true});
  return supports;
}

std::vector<RingSupport> spline_supports(const SplineHeld& spline, double width, double sense) {
  if (spline.teeth < 3) throw InputError("a splined ring needs at least three spline teeth");
  constexpr double flank_stiffness_per_width = 14e9;  // Pa
  const double pitch = 2 * M_PI / spline.teeth;
  const double stiffness = spline.flank_stiffness.value_or(flank_stiffness_per_width * width);
  std::vector<RingSupport> supports;
  for (int i = 0; i < spline.teeth; ++i)
    for (const double side : {-1.0, 1.0})  // the flank on this side of the tooth is pushed the other way, and inwards
      supports.push_back({sense * (spline.first_tooth_angle + i * pitch), pitch / 4, Spread::uniform,
                          std::sin(spline.flank_angle), -side * std::cos(spline.flank_angle), stiffness,
                          spline.clearance, true});
  return supports;
}

}  // namespace

std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius, double width,
                                       int ring_teeth, const Material& material, bool mirrored) {
  const double sense = mirrored ? -1 : 1;
  if (const auto* pins = std::get_if<PinHeld>(&structure))
    return pin_supports(*pins, outside_radius, width, ring_teeth, material, sense);
  if (const auto* spline = std::get_if<SplineHeld>(&structure)) return spline_supports(*spline, width, sense);
  if (std::holds_alternative<OutsideHeld>(structure)) return {};
  throw InputError(
      "a ring held at an end face or a flange bends along its width, for which the closed form has no honest formula: "
      "use rung = \"solid\"");
}

}  // namespace annulus::fem
