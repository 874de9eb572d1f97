#pragma once

#include <array>
#include <vector>

namespace annulus::fem {

/// Gap of two flanks round the place where they are nearest, x along the flank from there. Its slope is
///
///     h'(x) = slope + curvature x + the jumps of all kinks below x
///
/// over `low` ... `high`, where both flanks exist. Convex: jumps and curvature are not negative.
struct FlankGap {
  struct Kink {
    double place = 0, jump = 0;  ///< m, rad; no kink when the jump is zero
  };
  double slope = 0, curvature = 0;  ///< rad, 1/m
  double low = 0, high = 0;         ///< m, low <= 0 <= high
  std::array<Kink, 2> kinks{};      ///< where a tip relief starts, pinion and wheel
};

/// Where two half planes touch along a convex gap, without friction: the solution of the singular integral equation of
/// the half plane [Johnson1985, sec. 2.7], with a pressure that vanishes at the ends of the patch
/// unless an end of the gap cuts it, where it is singular. With the half-width a and the middle c, x = c + a cos(t),
///
///     S = 1/pi int_0^pi h'(x) dt,   m = 1/pi int_0^pi h'(x) a cos(t) dt
///     F' = pi E* / 2 (m + a |S|),   S = 0 for a free patch
///
/// For a parabola alone it is Hertz's contact. The bodies bend, and softer at one side than at the other turn the
/// flanks against each other by `tilt` F': that adds to h' and moves the patch to the stiffer side.
class ContactPatch {
 public:
  /// `effective_modulus` E* = E / (2 (1 - nu^2)) of two equal bodies, Pa; `tilt` in rad per N/m.
  ContactPatch(const FlankGap& gap, double tilt, double effective_modulus);

  struct State {
    double middle = 0;     ///< m
    double line_load = 0;  ///< N/m
    int cut = 0;           ///< -1, 1: the patch ends at the low, high end of the gap
  };
  [[nodiscard]] State at(double half_width) const;
  /// Half-width under a line load, m; half of the gap when all of it has closed.
  [[nodiscard]] double half_width(double line_load) const;
  /// Half-widths where the patch begins or ceases to be cut or meets a kink, ascending, m: between them all is smooth.
  [[nodiscard]] const std::vector<double>& borders() const { return borders_; }

 private:
  [[nodiscard]] double mean_slope(double half_width, double middle) const;  ///< S
  [[nodiscard]] double moment(double half_width, double middle) const;      ///< m
  void find_borders();

  FlankGap gap_;
  double tilt_, stiffness_, largest_;  ///< stiffness: pi E* / 2
  bool kinked_;
  std::vector<double> borders_;
};

}  // namespace annulus::fem
