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
  Spread spread = Spread::parabolic;
  double inwards = 0;     ///< components of the unit force on the rim: radially inwards
  double tangential = 0;  ///< and counter-clockwise
  double stiffness = 0;   ///< N/m
  double gap = 0;         ///< m, play before it touches
  bool unilateral = true;
};

/// The supports of a ring: pins give two each (radial, tangential), spline teeth two each (their flanks), in that
/// order; a housing bore adds one per tooth of the ring after them. `outside_radius` and `width` in m; `mirrored`:
/// angles change sign. Empty when the outside is held.
///
/// Stiffness where the scene gives none: a pin as in the finite-element rungs, in series with its two free spans, beams
/// whose ends shift without turning, k = 2 / (L^3 / (12 E I) + L / (kappa G A)), kappa = 6 (1 + nu) / (7 + 6 nu)
/// (Cowper 1966); a spline flank 14 N/(mm um) times the width (magnitude of ISO 6336-1 for a tooth pair).
///
/// Throws InputError for structures that no set of supports describes, and when equilibrium is out of reach (fewer than
/// two pins without a bore).
[[nodiscard]] std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius,
                                                     double width, int ring_teeth, const Material& material,
                                                     bool mirrored);

}  // namespace annulus::fem
