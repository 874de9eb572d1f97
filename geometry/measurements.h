#pragma once

#include "geometry/gear_pair.h"

/// What is measured on a gear and printed on its drawing, and the profile shift that follows from it [ISO21771]. Radii
/// and thicknesses on circles are in geometry/gear.h.
namespace annulus::geometry {

/// Teeth (external) or spaces (internal) of the base tangent length that touches the flanks nearest to the middle
/// between tip and form circle.
[[nodiscard]] int usual_span_teeth(const Gear& gear);

/// Diameter (m) of the pins, or balls for helical gears, that touch the flanks on the circle of the reference radius
/// plus x m_n, where the space is half a pitch wide.
[[nodiscard]] double usual_pin_diameter(const Gear& gear);

/// Dimension over two pins (external) or between them (internal) in opposite spaces, balls for helical gears, m. For an
/// odd number of teeth the spaces are half a pitch off the diameter. Throws GeometryError for pins that do not touch an
/// involute within the tooth.
[[nodiscard]] double dimension_over_pins(const Gear& gear, double pin_diameter);

/// Thickness (external: of the tooth; internal: of the tooth beside the space) on the reference circle in the normal
/// section, m.
[[nodiscard]] double normal_tooth_thickness(const Gear& gear);

/// Profile shifts, in modules, of the gear with these parameters, whose own shift is not read. Lengths in m. They are
/// those of teeth without allowances; a backlash allowance in a measured length comes out as a smaller shift.
[[nodiscard]] double shift_from_span(const GearParameters& gear, int teeth, double length);
/// Throws GeometryError where pins of this diameter cannot lie at this dimension.
[[nodiscard]] double shift_from_pins(const GearParameters& gear, double pin_diameter, double dimension);
/// With an addendum of one module and a dedendum of 1.25 modules [ISO53, profile A].
[[nodiscard]] double shift_from_tip_diameter(const GearParameters& gear, double diameter);
[[nodiscard]] double shift_from_root_diameter(const GearParameters& gear, double diameter);

/// Sum x_1 + x_2 of an external pair, difference x_2 - x_1 of an internal one (2: the ring), that leaves a normal
/// backlash (m) at a working centre distance (m). `wheel` states the kind; shifts are not read. Throws GeometryError
/// where no working pressure angle exists.
[[nodiscard]] double shifts_from_centre_distance(const GearParameters& pinion, const GearParameters& wheel,
                                                 double centre_distance, double normal_backlash);

/// Specific sliding at the two ends of the path of contact: 1 - (speed of the mate's flank) / (its own), along the
/// flank; 0 at the pitch point, below it negative.
struct SpecificSliding {
  double pinion_at_root = 0, wheel_at_tip = 0;  ///< where the wheel's tip touches
  double pinion_at_tip = 0, wheel_at_root = 0;  ///< where the pinion's tip touches
};
[[nodiscard]] SpecificSliding specific_sliding(const GearPair& pair);

}  // namespace annulus::geometry
