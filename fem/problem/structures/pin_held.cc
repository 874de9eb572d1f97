#include "fem/problem/structures/pin_held.h"

#include <cmath>

#include "core/beam.h"
#include "core/errors.h"
#include "fem/problem/ring_structure.h"

namespace annulus::fem {

RingDescription PinHeld::describe(double outside_radius) const {
  constexpr double absent = -1;
  const auto count = static_cast<int>(angles.size());
  RingDescription d;
  d.body.held = HeldSurface::none;
  d.opens = unilateral;
  auto& words = d.words;
  words.name = unilateral ? "pinned" : "bolted";
  words.support = unilateral ? "pin" : "bolt";
  words.supports = words.support + "s";
  const auto& called = count == 1 ? words.support : words.supports;
  words.description = std::to_string(count) + " " + called;
  words.plane_reason = unilateral ? "the pins carry over the full width" : "the bolts hold over the full width";
  if (count == 1)
    words.repetition = "a single support";
  else if (count > 0 && maps_onto_itself(angles, 2 * M_PI / count))
    words.repetition = std::to_string(count) + " equal supports";
  else
    words.repetition = std::to_string(count) + " supports at given angles";
  words.map_caption = unilateral
                          ? "coloured by the force with which the rim presses on it, grey while the rim has lifted off"
                          : "orange while the rim presses outwards on it, blue while the rim pulls";
  for (const double angle : angles) d.parameters.emplace_back("pin", angle);
  d.parameters.insert(d.parameters.end(), {{"pin_diameter", pin_diameter},
                                           {"clearance", clearance},
                                           {"free_span", free_span},
                                           {"pin_stiffness", radial_stiffness.value_or(absent)},
                                           {"pin_tangential_stiffness", tangential_stiffness.value_or(absent)},
                                           {"housing_clearance", housing_clearance.value_or(absent)}});
  d.drawing.cylinders = {{called, angles, outside_radius, pin_diameter}};
  if (housing_clearance) d.drawing.bore = RingDrawing::Bore::around_outside;
  d.support_angles = angles;
  return d;
}

SupportSites PinHeld::supports(const SupportedRing& ring) const {
  if (angles.empty()) throw InputError("a pinned ring needs at least one pin");
  if (angles.size() == 1 && !housing_clearance)
    throw InputError(
        "a ring on one pin turns about it and cannot be in equilibrium without a housing bore around it: give the "
        "housing's clearance, or a second pin");
  const double local = derived_pin_stiffness(ring.material, ring.face_width);
  SupportDirection radial, tangential;
  radial.unilateral = unilateral;
  radial.clearance = clearance;
  radial.stiffness = radial_stiffness.value_or(local);
  if (!radial_stiffness) radial.end_stiffness = pin_span_stiffness(ring.material, pin_diameter, free_span);
  tangential = radial;
  tangential.inward = 0;
  tangential.counter_clockwise = 1;
  tangential.unilateral = false;
  tangential.clearance = 0;
  if (tangential_stiffness) {
    tangential.stiffness = *tangential_stiffness;
    tangential.end_stiffness = std::numeric_limits<double>::infinity();
  }
  SupportSites result;
  result.pins = static_cast<int>(angles.size());
  for (const double angle : angles)
    result.sites.push_back({-angle, pin_diameter / 2 / ring.outside_radius, true, {radial, tangential}});
  if (housing_clearance) {
    SupportDirection bore;
    bore.clearance = *housing_clearance;
    bore.stiffness = local;  // the width of a squeezed prism over its height does not depend on its size
    const double pitch = 2 * M_PI / ring.teeth;
    for (int tooth = 0; tooth < ring.teeth; ++tooth) result.sites.push_back({-tooth * pitch, pitch / 2, false, {bore}});
  }
  return result;
}

double derived_pin_stiffness(const Material& material, double length) {
  return M_PI * material.youngs_modulus * length / (4 * (1 - material.poisson_ratio * material.poisson_ratio));
}

double pin_span_stiffness(const Material& material, double diameter, double span) {
  if (span <= 0) return std::numeric_limits<double>::infinity();
  return 2 / circular_beam(diameter, material.youngs_modulus, material.poisson_ratio).parallel_shift(span);
}

}  // namespace annulus::fem
