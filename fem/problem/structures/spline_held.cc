#include "fem/problem/structures/spline_held.h"

#include <cmath>
#include <numeric>

#include "core/errors.h"

namespace annulus::fem {

RingBody SplineHeld::body(double /*outside_radius*/) const {
  RingBody body;
  body.held = HeldSurface::none;
  return body;
}

RingWords SplineHeld::words() const {
  RingWords words;
  words.name = "splined";
  words.support = "spline tooth";
  words.supports = "spline teeth";
  words.description = std::to_string(teeth) + " splines";
  words.plane_reason = "the splines carry over the full width";
  words.repetition = std::to_string(teeth) + " splines";
  words.map_caption = "coloured by the resultant of its flanks, grey while neither of them touches";
  return words;
}

std::vector<std::pair<std::string, double>> SplineHeld::parameters() const {
  constexpr double absent = -1;
  return {{"splines", teeth},
          {"first_spline", first_tooth_angle},
          {"flank_angle", flank_angle},
          {"clearance", clearance},
          {"flank_stiffness", flank_stiffness.value_or(absent)}};
}

RingDrawing SplineHeld::drawing(double /*outside_radius*/) const {
  RingDrawing drawing;
  drawing.teeth = {words().supports, equal_angles(teeth, first_tooth_angle), flank_angle};
  drawing.shown_force = ShownForce::resultant;
  return drawing;
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

int SplineHeld::repeating_teeth(int ring_teeth) const { return ring_teeth / std::gcd(ring_teeth, teeth); }

double derived_spline_stiffness(const Material& material, double width) {
  constexpr double of_steel = 14e9, steel = 206e9;  // Pa
  return of_steel * material.youngs_modulus / steel * width;
}

}  // namespace annulus::fem
