#pragma once

#include <vector>

#include "fem/closed_form/ring_loads.h"
#include "fem/material.h"
#include "fem/ring_structure.h"

namespace annulus::fem {

/// One support of a ring's outside in one direction: a spring of the housing pushing on the rim over a short arc.
struct RingSupport {
  double angle = 0;       ///< rad, middle of the arc, from the centre of tooth 0
  double half_angle = 0;  ///< rad
  double inwards = 0;     ///< components of the unit force on the rim: radially inwards
  double tangential = 0;  ///< and counter-clockwise
  double stiffness = 0;   ///< N/m
  double gap = 0;         ///< m, play before it touches
  bool unilateral = true;
};

/// The supports of a pinned, bolted or splined ring of outside radius `outside_radius` and width `width` (m). Pins give
/// two each (radial, tangential), splines two per tooth (its flanks), in that order; a housing bore adds one per tooth
/// pitch of the ring after them. `mirrored`: angles change sign.
///
/// A pin's stiffness, when absent, is that of the finite-element rungs, in series with a beam clamped at both ends over
/// its free span. Throws InputError for structures that no set of supports describes, and when equilibrium is out of
/// reach (fewer than two pins without a bore).
[[nodiscard]] std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius,
                                                     double width, int ring_teeth, const Material& material,
                                                     bool mirrored);

}  // namespace annulus::fem
