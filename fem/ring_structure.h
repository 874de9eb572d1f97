#pragma once

#include <optional>
#include <variant>

namespace annulus::fem {

/// Outer surface held over the full face width.
struct OutsideHeld {};

/// Cantilever: a toothless sleeve continues the rim below the teeth, its end face is held, the outside is free.
struct EndFaceHeld {
  double free_length = 0;       ///< m, sleeve between the held face and the teeth
  double sleeve_thickness = 0;  ///< m, at the outside diameter
};

/// Pins between the outside diameter and a rigid housing. A pin sits in a groove: it resists radial motion of the rim
/// outwards only (it lifts off inwards) and tangential motion both ways; `unilateral = false` holds it both ways
/// (bolted).
struct PinHeld {
  int pins = 0;
  double pin_diameter = 0;                   ///< m
  double clearance = 0;                      ///< m, radial play
  std::optional<double> radial_stiffness{};  ///< N/m per pin; absent: derived from the pin
  double first_pin_angle = 0;                ///< rad, from the centre of tooth 0
  bool unilateral = true;
};

using RingStructure = std::variant<OutsideHeld, EndFaceHeld, PinHeld>;

}  // namespace annulus::fem
