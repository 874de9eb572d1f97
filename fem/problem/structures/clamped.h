#pragma once

#include "fem/problem/ring_body.h"

namespace annulus::fem {

/// Clamped between two rigid housings by bolts through the rim: the usual ring of a wind turbine gearbox. Friction of
/// the preloaded joints, helped by dowels, holds both end faces in all directions from an inner diameter out to the
/// outside diameter; they take the axial force as well. The outside and the rest of the end faces are free.
///
/// Assumptions: the joints neither slip nor open, the pressure cones of neighbouring bolts overlap (the clamped area is
/// a closed annulus, so that one mesh cycle repeats), holes are not meshed, housings are rigid. Bolts and dowels lie in
/// the annulus and, where it does not slip, carry nothing: they are drawn, and do not enter the solution.
struct Clamped {
  double inner_radius = 0;        ///< m, of the clamped annulus
  int bolts = 0;                  ///< equally spaced
  double bolt_circle_radius = 0;  ///< m
  double bolt_diameter = 0;       ///< m
  double first_bolt_angle = 0;    ///< rad, from the centre of tooth 0
  int dowels = 0;                 ///< equally spaced, on the bolt circle in the middle between two bolts
  double dowel_diameter = 0;      ///< m

  [[nodiscard]] RingDescription describe(double outside_radius) const;
};

}  // namespace annulus::fem
