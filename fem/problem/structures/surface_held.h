#pragma once

#include <optional>

#include "fem/problem/ring_body.h"

namespace annulus::fem {

/// A toothless flange around the lower end of the ring; its end face is bolted down beyond the outside diameter (a
/// closed joint: held both ways), the outside above it is free.
struct FlangeHeld {
  double width = 0;           ///< m, axial, from the lower end face of the teeth
  double outside_radius = 0;  ///< m, of the flange

  [[nodiscard]] RingDescription describe(double ring_outside_radius) const;
};

/// Cantilever: a toothless sleeve continues the rim below the teeth, its end face is held, the outside is free.
struct EndFaceHeld {
  double free_length = 0;       ///< m, sleeve between the held face and the teeth; 0: they stand on the held face
  double sleeve_thickness = 0;  ///< m, at the outside diameter
  std::optional<Hoop> hoop{};   ///< stiffens the free end

  [[nodiscard]] RingDescription describe(double outside_radius) const;
};

}  // namespace annulus::fem
