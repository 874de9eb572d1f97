#pragma once

#include <optional>
#include <variant>
#include <vector>

namespace annulus::fem {

/// Outer surface held over the full face width.
struct OutsideHeld {};

/// A toothless flange around the lower end of the ring; its end face is bolted down beyond the outside diameter (a
/// closed joint: held both ways), the outside above it is free.
struct FlangeHeld {
  double width = 0;           ///< m, axial, from the lower end face of the teeth
  double outside_radius = 0;  ///< m, of the flange
};

/// A toothless band around the outside of the rim at its free end.
struct Hoop {
  double width = 0;      ///< m, axial
  double thickness = 0;  ///< m, radial, beyond the outside diameter
};

/// Cantilever: a toothless sleeve continues the rim below the teeth, its end face is held, the outside is free.
struct EndFaceHeld {
  double free_length = 0;       ///< m, sleeve between the held face and the teeth; 0: they stand on the held face
  double sleeve_thickness = 0;  ///< m, at the outside diameter
  std::optional<Hoop> hoop{};   ///< stiffens the free end
};

/// Pins between the outside diameter and a rigid housing. A pin sits in a groove: it resists radial motion of the rim
/// outwards only (it lifts off inwards) and tangential motion both ways; `unilateral = false` holds it both ways
/// (bolted).
struct PinHeld {
  std::vector<double> angles;                    ///< rad, of every pin, from the centre of tooth 0
  double pin_diameter = 0;                       ///< m
  double clearance = 0;                          ///< m, radial play
  double free_span = 0;                          ///< m, of pin between ring and housing: there it bends and shears
  std::optional<double> radial_stiffness{};      ///< N/m per pin; absent: derived from the pin
  std::optional<double> tangential_stiffness{};  ///< N/m per pin; absent: as radial
  std::optional<double> housing_clearance{};     ///< m, radial play of the rim in a housing bore; absent: no bore
  bool unilateral = true;
};

/// Spline teeth around the outside in a rigid mate: each of their flanks is a unilateral support along its normal.
struct SplineHeld {
  int teeth = 0;
  double flank_angle = 0;                   ///< rad, between the flank and the radius at the outside diameter
  double clearance = 0;                     ///< m, normal to each flank
  std::optional<double> flank_stiffness{};  ///< N/m per flank; absent: derived
  double first_tooth_angle = 0;             ///< rad, from the centre of tooth 0 of the ring
};

using RingStructure = std::variant<OutsideHeld, EndFaceHeld, PinHeld, FlangeHeld, SplineHeld>;

/// `count` equally spaced angles, rad.
[[nodiscard]] std::vector<double> equal_angles(int count, double first);

/// Whether the ring rests on single supports (pins, bolts, splines) instead of being held by a surface.
[[nodiscard]] bool on_single_supports(const RingStructure& structure);

/// The smallest number of teeth by which a ring of `teeth` teeth can be turned so that its structure looks the same:
/// its contact repeats after so many mesh cycles.
[[nodiscard]] int repeating_teeth(const RingStructure& structure, int teeth);

}  // namespace annulus::fem
