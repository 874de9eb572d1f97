#pragma once

#include <string>

#include "app/report/drawings/drawing_page.h"
#include "fem/problem/ring_structure.h"

namespace annulus::app {

/// Air that drawings leave beyond a ring for its supports, m.
[[nodiscard]] double support_margin(const fem::RingStructure& structure, double outside_radius);

/// The supports of a ring in the transverse section: the held outside, pins, bolts and dowels, spline teeth, a housing
/// bore. Held end faces and flanges lie elsewhere. `first`: polar angle of the ring's tooth 0; only what lies within
/// `reach` of it is drawn, rad.
[[nodiscard]] std::string drawn_supports(const DrawingPage& page, const fem::RingStructure& structure,
                                         double outside_radius, double first, double reach);

/// An outer surface held all over.
[[nodiscard]] std::string held_arc(const DrawingPage& page, double radius, double first, double reach);

}  // namespace annulus::app
