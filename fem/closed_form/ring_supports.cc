#include "fem/closed_form/ring_supports.h"

#include <cmath>

#include "core/errors.h"
#include "fem/mesh_bodies.h"

namespace annulus::fem {
namespace {

/// Two conforming half-grooves around the pin, in series with its free span: a round beam clamped at both ends,
/// L^3 / (12 E I) + L / (0.9 G A).
double pin_stiffness(const PinHeld& pins, const Material& material, double width) {
  const double d = pins.pin_diameter, area = M_PI * d * d / 4, inertia = M_PI * std::pow(d, 4) / 64;
  const double shear_modulus = material.youngs_modulus / (2 * (1 + material.poisson_ratio));
  const double span = pins.free_span;
  return 1 / (1 / derived_pin_stiffness(material, width) +
              std::pow(span, 3) / (12 * material.youngs_modulus * inertia) + span / (0.9 * shear_modulus * area));
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
    supports.push_back({sense * angle, half_angle, 1, 0, radial, pins.clearance, pins.unilateral});
    supports.push_back({sense * angle, half_angle, 0, 1, tangential, 0, false});
  }
  if (pins.housing_clearance) {
    // The bore itself is rigid; the spring that a support needs is a layer as deep as it is long, F / (E' width).
    const double bore = material.youngs_modulus * width / (1 - material.poisson_ratio * material.poisson_ratio);
    for (int i = 0; i < ring_teeth; ++i)
      supports.push_back({2 * M_PI * i / ring_teeth, M_PI / ring_teeth, 1, 0, bore, *pins.housing_clearance, true});
  }
  return supports;
}

std::vector<RingSupport> spline_supports(const SplineHeld& spline, double sense) {
  if (!spline.flank_stiffness)
    throw InputError("the closed form needs the stiffness of a spline flank: give it, or use rung = \"plane\"");
  const double pitch = 2 * M_PI / spline.teeth;
  std::vector<RingSupport> supports;
  for (int i = 0; i < spline.teeth; ++i)
    for (const double side : {-1.0, 1.0})  // the flank on this side of the tooth is pushed the other way, and inwards
      supports.push_back({sense * (spline.first_tooth_angle + i * pitch) + side * pitch / 4, pitch / 8,
                          std::sin(spline.flank_angle), -side * std::cos(spline.flank_angle), *spline.flank_stiffness,
                          spline.clearance, true});
  return supports;
}

}  // namespace

std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius, double width,
                                       int ring_teeth, const Material& material, bool mirrored) {
  const double sense = mirrored ? -1 : 1;
  if (const auto* pins = std::get_if<PinHeld>(&structure))
    return pin_supports(*pins, outside_radius, width, ring_teeth, material, sense);
  if (const auto* spline = std::get_if<SplineHeld>(&structure)) return spline_supports(*spline, sense);
  if (std::holds_alternative<OutsideHeld>(structure)) return {};
  throw InputError(
      "a ring held at an end face or a flange bends along its width, for which the closed form has no honest formula: "
      "use rung = \"solid\"");
}

}  // namespace annulus::fem
