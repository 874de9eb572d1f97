#include "fem/problem/ring_structure.h"

namespace annulus::fem {

RingBody OutsideHeld::body(double /*outside_radius*/) const { return {}; }

RingWords OutsideHeld::words() const {
  RingWords words;
  words.name = "outside_held";
  words.description = "outer surface held";
  words.plane_reason = "the outer surface is held over the full width";
  return words;
}

std::vector<std::pair<std::string, double>> OutsideHeld::parameters() const { return {}; }

RingDrawing OutsideHeld::drawing(double /*outside_radius*/) const { return {}; }

}  // namespace annulus::fem
