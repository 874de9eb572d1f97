#pragma once

#include <limits>
#include <vector>

#include "fem/problem/material.h"
#include "fem/problem/ring_structure.h"

namespace annulus::fem {

/// One way in which a support presses on the ring.
struct SupportDirection {
  double inward = 1, counter_clockwise = 0;  ///< unit vector of the force on the ring
  bool unilateral = true;
  double clearance = 0;  ///< m
  double stiffness = 0;  ///< N/m, spread evenly over the face width
  /// N/m, of both ends of the support together, each taking its share by the lever rule, in series with `stiffness`.
  double end_stiffness = std::numeric_limits<double>::infinity();
  [[nodiscard]] double total_stiffness() const { return 1 / (1 / stiffness + 1 / end_stiffness); }
};

/// One place of the outside of a ring that is supported.
struct SupportSite {
  double angle = 0;       ///< rad, polar angle in the frame of the solve
  double half_arc = 0;    ///< rad
  bool parabolic = true;  ///< pressure over the arc: parabola, else uniform
  std::vector<SupportDirection> directions;
};

/// The supports around a ring: pins or spline teeth, then the patches of a housing bore, one behind every tooth.
struct SupportSites {
  std::vector<SupportSite> sites;
  int pins = 0;  ///< number of pins or spline teeth: the first sites
};

/// What the supports touch.
struct SupportedRing {
  int teeth = 0;
  double outside_radius = 0;  ///< m
  double face_width = 0;      ///< m
  Material material;
};

/// Pins: radially one-sided or both ways, tangentially both ways. Angles change sign: the frame of the solve is the
/// mirror image of the real ring. Throws InputError when the pins cannot hold the ring in equilibrium.
[[nodiscard]] SupportSites pin_sites(const PinHeld& pins, const SupportedRing& ring);
/// Spline teeth: both flanks one-sided along their normals, uniform over the thickness of the tooth, half its pitch.
[[nodiscard]] SupportSites spline_sites(const SplineHeld& spline, const SupportedRing& ring);

/// Stiffness of one pin between two conforming half-grooves, N/m: a solid cylinder of diameter D squeezed over its
/// full width behaves like a prism of its mean width pi D / 4 and height D, k = pi E L / (4 (1 - nu^2)). An estimate:
/// it leaves out the local compliance of a real housing.
[[nodiscard]] double derived_pin_stiffness(const Material& material, double length);

/// Stiffness of the two free spans of a circular pin of diameter `diameter` between ring and housing, one on either
/// side of the ring, N/m: each a beam whose ends shift against each other without turning,
///
///     k = 2 / (L^3 / (12 E I) + L / (kappa G A)),  I = pi D^4 / 64,  A = pi D^2 / 4,
///
/// with the shear coefficient of a circle kappa = 6 (1 + nu) / (7 + 6 nu) (Cowper 1966). Half the span bends as a
/// cantilever with the shear force at its tip, (L/2)^3 / (3 E I); two halves make L^3 / (12 E I). Infinite for a span
/// of zero.
[[nodiscard]] double pin_span_stiffness(const Material& material, double diameter, double span);

/// Stiffness of one flank of a spline tooth, N/m: that of a gear tooth pair, 14 N/(mm um) (ISO 6336-1, magnitude of the
/// theoretical single stiffness) times the width for steel, in proportion to Young's modulus otherwise. An estimate,
/// whatever the module.
[[nodiscard]] double derived_spline_stiffness(const Material& material, double width);

}  // namespace annulus::fem
