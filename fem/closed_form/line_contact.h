#pragma once

#include <cmath>
#include <limits>

#include "fem/closed_form/contact_patch.h"
#include "fem/problem/material.h"

namespace annulus::fem {

/// Elastic approach of two flanks that touch along a line, surface against the points on the contact normal at the
/// depths h, where the teeth's centre lines lie and the beams begin.
///
/// Hertz's contact with the half-width a has, for each body,
///
///     delta = 2 (1 - nu^2) F' / (pi E) [asinh(h/a) - nu/(1-nu) (h/a) (sqrt(1 + (h/a)^2) - h/a)]
///
/// It follows from the stresses on the axis below the contact [Johnson1985, eq. 4.46] by integration of
/// the strain, plane strain; deep below the contact the bracket is ln(2h/a) - nu / (2 (1 - nu)), the form of
/// [WeberBanaschek1953] and of [Johnson1985, eq. 5.57]. Whatever the gap, an increment of the force acts on the patch
/// as it is, like a flat punch: as in Hertz's contact of the same width, d delta = 2 (1 - nu^2) dF' / (pi E) B(a), B
/// being (1 + 1/2 d/d ln a) of that bracket. Summed over the growth of the patch (fem/closed_form/contact_patch.h) this
/// gives the approach.
///
/// Where the teeth yield more towards one side, by 2 `tilt` x, the patch moves and its increments act at its middle c:
///
///     d delta = (2 tilt c - pi E* a^2 / 4 tilt^2) dF'
///
/// the second term being the pressure that moves with the tilting flank.
///
/// Within some `edge_reach` h of its tip edge a tooth is no half space but a wedge with the angle 2 alpha of its
/// corner. Loads on the corner of a wedge, across and along its axis, yield 1/(alpha - sin(2 alpha)/2) and
/// 1/(alpha + sin(2 alpha)/2) for the 2/pi of a half plane (Michell's solution [TimoshenkoGoodier1970, art. 38]), a
/// load normal to the flank
///
///     1 + k = pi/2 [cos^2(alpha) / (alpha - sin(2 alpha)/2) + sin^2(alpha) / (alpha + sin(2 alpha)/2)]
///
/// times as much. That holds between the distance d of the patch from the edge and the reach; beyond it the beam takes
/// over: B grows by k/2 ln(1 + (edge_reach h / d)^2).
class LineContact {
 public:
  /// Measured, not derived: the best of 0, 0.1, 0.2, 0.3 and 0.5 against plane finite elements (docs/methods.md).
  static constexpr double edge_reach = 0.1;

  struct Body {
    double depth = 0;                                       ///< m, h
    double edge = std::numeric_limits<double>::infinity();  ///< m, from x = 0 to the tip edge; infinite: none
    double corner = M_PI;                                   ///< rad, angle of the material there
  };
  /// `gap` of the flanks, with the tip edge of the pinion at x > 0 and that of the wheel at x < 0. `tilt`: half of how
  /// the compliance of both teeth grows with x, rad per N/m of line load. `width` of the contact in m.
  LineContact(const FlankGap& gap, const Body& pinion, const Body& wheel, double tilt, const MeshMaterials& materials,
              double width);

  struct State {
    double half_width = 0, middle = 0;  ///< m, of the patch
    double approach = 0;                ///< m, both bodies
    double compliance = 0;              ///< d approach / d force, m/N
    bool at_tip_edge = false;           ///< a tip edge cuts the patch: singular pressure
  };
  [[nodiscard]] State at(double force) const;  ///< force > 0

  /// As if the pressure were Hertz's over that patch, Pa.
  [[nodiscard]] double peak_pressure(const State& state, double force) const;

 private:
  struct Increment {
    double value = 0, slope = 0;  ///< of both bodies, m per N/m, and by the half-width, per N/m
  };
  [[nodiscard]] Increment increment(double half_width, double middle, double middle_slope) const;

  ContactPatch patch_;
  double tilt_, width_;
  Body pinion_, wheel_;
  double pinion_wedge_, wheel_wedge_;  // k
  MeshMaterials materials_;
};

}  // namespace annulus::fem
