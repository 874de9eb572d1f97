#include "fem/problem/structures/spline_held.h"

#include <cmath>
#include <string>

#include "core/errors.h"

namespace annulus::fem {

RingDescription SplineHeld::describe(double /*outside_radius*/) const {
  constexpr double absent = -1;
  RingDescription d;
  d.body.held = HeldSurface::none;
  d.opens = true;
  d.words.name = "splined";
  d.words.support = "spline tooth";
  d.words.supports = "spline teeth";
  d.words.description = d.words.repetition = std::to_string(teeth) + " splines";
  d.words.plane_reason = "the splines carry over the full width";
  d.words.map_caption = "coloured by the resultant of its flanks, grey while neither of them touches";
  d.parameters = {{"splines", teeth},
                  {"first_spline", first_tooth_angle},
                  {"flank_angle", flank_angle},
                  {"clearance", clearance},
                  {"flank_stiffness", flank_stiffness.value_or(absent)}};
  d.support_angles = equal_angles(teeth, first_tooth_angle);
  d.drawing.teeth = {d.words.supports, d.support_angles, flank_angle};
  d.drawing.shown_force = ShownForce::resultant;
  return d;
}

SupportSites SplineHeld::supports(const SupportedRing& ring) const {
  if (teeth < 3) throw InputError("a splined ring needs at least three spline teeth, and has " + std::to_string(teeth));
  SupportSites result;
  result.pins = teeth;
  const double pitch = 2 * M_PI / teeth;
  SupportDirection clockwise, counter_clockwise;
  clockwise.clearance = counter_clockwise.clearance = clearance;
  clockwise.stiffness = counter_clockwise.stiffness =
      flank_stiffness.value_or(derived_spline_stiffness(ring.material, ring.face_width));
  clockwise.inward = counter_clockwise.inward = std::sin(flank_angle);
  counter_clockwise.counter_clockwise = std::cos(flank_angle);
  clockwise.counter_clockwise = -std::cos(flank_angle);
  for (int tooth = 0; tooth < teeth; ++tooth)
    result.sites.push_back({-(first_tooth_angle + tooth * pitch), pitch / 4, false, {counter_clockwise, clockwise}});
  return result;
}

double derived_spline_stiffness(const Material& material, double width) {
  constexpr double of_steel = 14e9, steel = 206e9;  // Pa
  return of_steel * material.youngs_modulus / steel * width;
}

}  // namespace annulus::fem
