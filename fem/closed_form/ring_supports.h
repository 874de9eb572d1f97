#pragma once

#include <vector>

#include "fem/closed_form/ring_loads.h"
#include "fem/problem/material.h"
#include "fem/problem/ring_structure.h"

namespace annulus::fem {

/// One support of a ring's outside in one direction: a spring of the housing pushing on the rim over a short arc.
struct RingSupport {
  double angle = 0;       ///< rad, middle of the arc, from the centre of tooth 0
  double half_angle = 0;  ///< rad
  Spread spread = Spread::parabolic;
  double inwards = 0;     ///< components of the unit force on the rim: radially inwards
  double tangential = 0;  ///< and counter-clockwise
  double stiffness = 0;   ///< N/m
  double gap = 0;         ///< m, play before it touches
  bool unilateral = true;
};

/// The supports of a ring, those of the finite-element models (RingStructure::supports): pins give two each
/// (radial, tangential), spline teeth two each (their flanks), in that order; a housing bore adds one per tooth of the
/// ring after them. Angles are those of the frame of the solve. `outside_radius` and `width` in m. Empty when the
/// outside is held.
///
/// Throws InputError for structures that no set of supports describes, and when equilibrium is out of reach.
[[nodiscard]] std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius,
                                                     double width, int ring_teeth, const Material& material);

}  // namespace annulus::fem
