#include "fem/problem/structures/flange_held.h"

namespace annulus::fem {

RingBody FlangeHeld::body(double /*ring_outside_radius*/) const {
  RingBody body;
  body.held = HeldSurface::flange_face;
  body.flange = Flange{width, outside_radius};
  return body;
}

RingWords FlangeHeld::words() const {
  RingWords words;
  words.name = "flange_held";
  words.description = "held by a flange";
  words.solid_reason = "a flange holds the ring at one end, so the deflection increases towards the other";
  words.asymmetry = "held by a flange at one end";
  return words;
}

std::vector<std::pair<std::string, double>> FlangeHeld::parameters() const {
  return {{"flange_width", width}, {"flange_radius", outside_radius}};
}

RingDrawing FlangeHeld::drawing(double /*ring_outside_radius*/) const { return {}; }

}  // namespace annulus::fem
