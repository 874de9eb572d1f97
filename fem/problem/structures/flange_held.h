#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fem/problem/ring_body.h"

namespace annulus::fem {

/// A toothless flange around the lower end of the ring; its end face is bolted down beyond the outside diameter (a
/// closed joint: held both ways), the outside above it is free.
struct FlangeHeld {
  double width = 0;           ///< m, axial, from the lower end face of the teeth
  double outside_radius = 0;  ///< m, of the flange

  [[nodiscard]] RingBody body(double ring_outside_radius) const;
  [[nodiscard]] RingWords words() const;
  [[nodiscard]] std::vector<std::pair<std::string, double>> parameters() const;
  [[nodiscard]] RingDrawing drawing(double ring_outside_radius) const;
};

}  // namespace annulus::fem
