#pragma once

#include <optional>
#include <vector>

#include "fem/problem/ring_body.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

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

  [[nodiscard]] RingDescription describe(double outside_radius) const;
  /// Every pin radially one-sided or both ways, tangentially both ways. Throws InputError without pins, and for a
  /// single one without a housing bore.
  [[nodiscard]] SupportSites supports(const SupportedRing& ring) const;
};

/// Stiffness of one pin between two conforming half-grooves, N/m: a solid cylinder of diameter D squeezed over its
/// full width behaves like a prism of its mean width pi D / 4 and height D, k = pi E L / (4 (1 - nu^2)). An estimate:
/// it leaves out the local compliance of a real housing.
[[nodiscard]] double derived_pin_stiffness(const Material& material, double length);

/// Stiffness of the two free spans of a circular pin of diameter `diameter` between ring and housing, one on either
/// side of the ring, N/m: each a beam whose ends shift against each other without turning,
///
///     k = 2 / (L^3 / (12 E I) + L / (kappa G A)),  I = pi D^4 / 64,  A = pi D^2 / 4,
///
/// with the shear coefficient of a circle kappa = 6 (1 + nu) / (7 + 6 nu) [Cowper1966]. Half the span bends as a
/// cantilever with the shear force at its tip, (L/2)^3 / (3 E I); two halves make L^3 / (12 E I). Infinite for a span
/// of zero.
[[nodiscard]] double pin_span_stiffness(const Material& material, double diameter, double span);

}  // namespace annulus::fem
