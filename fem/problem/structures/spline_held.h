#pragma once

#include <optional>

#include "fem/problem/ring_body.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

/// Spline teeth around the outside in a rigid mate: each of their flanks is a unilateral support along its normal.
struct SplineHeld {
  int teeth = 0;
  double flank_angle = 0;                   ///< rad, from the radius at the outside diameter [ISO4156]
  double clearance = 0;                     ///< m, normal to each flank
  std::optional<double> flank_stiffness{};  ///< N/m per flank; absent: derived
  double first_tooth_angle = 0;             ///< rad, from the centre of tooth 0 of the ring

  [[nodiscard]] RingDescription describe(double outside_radius) const;
  /// Both flanks of every tooth one-sided along their normals, uniform over the thickness of the tooth, half its pitch.
  /// Throws InputError for fewer than three teeth.
  [[nodiscard]] SupportSites supports(const SupportedRing& ring) const;
};

/// Stiffness of one flank of a spline tooth, N/m: that of a gear tooth pair, 14 N/(mm um) ([ISO6336-1], magnitude of
/// the theoretical single stiffness) times the width for steel, in proportion to Young's modulus otherwise. An
/// estimate, whatever the module.
[[nodiscard]] double derived_spline_stiffness(const Material& material, double width);

}  // namespace annulus::fem
