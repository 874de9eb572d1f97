#pragma once

#include <algorithm>
#include <cmath>

namespace annulus {

/// A beam that bends in one plane, and shears, stretches and twists; SI.
struct Beam {
  double bending = 0;  ///< E I, N m^2
  double shear = 0;    ///< kappa G A, N
  double axial = 0;    ///< E A, N
  double torsion = 0;  ///< G J, N m^2

  /// m/N: one end of a piece shifts against the other, and neither turns: L^3 / (12 E I) + L / (kappa G A).
  [[nodiscard]] double parallel_shift(double length) const {
    return std::pow(length, 3) / (12 * bending) + length / shear;
  }
  /// m/N: the free end of a cantilever under a force there: L^3 / (3 E I) + L / (kappa G A).
  [[nodiscard]] double cantilever(double length) const { return std::pow(length, 3) / (3 * bending) + length / shear; }
  /// rad/(N m): the free end of a cantilever under a moment there: L / (E I).
  [[nodiscard]] double cantilever_bend(double length) const { return length / bending; }
  /// rad/N: L^2 / (2 E I).
  [[nodiscard]] double cantilever_tilt(double length) const { return length * length / (2 * bending); }
};

/// `diameter`: m. Shear coefficient kappa = 6 (1 + nu) / (7 + 6 nu) [Cowper1966].
[[nodiscard]] inline Beam circular_beam(double diameter, double youngs_modulus, double poisson_ratio) {
  const double area = M_PI * diameter * diameter / 4, shear_modulus = youngs_modulus / (2 * (1 + poisson_ratio));
  const double second_moment = M_PI * std::pow(diameter, 4) / 64;
  return {youngs_modulus * second_moment, 6 * (1 + poisson_ratio) / (7 + 6 * poisson_ratio) * shear_modulus * area,
          youngs_modulus * area, shear_modulus * 2 * second_moment};
}

/// A rectangle, m: `width` in the plane in which it bends, `depth` across. Shear coefficient kappa = 10 (1 + nu) /
/// (12 + 11 nu) [Cowper1966]; torsion by a b^3 (1/3 - 0.21 b/a (1 - b^4 / (12 a^4))) of the sides a >= b [Roark2002],
/// within 0.5 %.
[[nodiscard]] inline Beam rectangular_beam(double width, double depth, double youngs_modulus, double poisson_ratio) {
  const double area = width * depth, shear_modulus = youngs_modulus / (2 * (1 + poisson_ratio));
  const double a = std::max(width, depth), b = std::min(width, depth);
  const double torsion = a * std::pow(b, 3) * (1.0 / 3 - 0.21 * b / a * (1 - std::pow(b / a, 4) / 12));
  return {youngs_modulus * depth * std::pow(width, 3) / 12,
          10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio) * shear_modulus * area, youngs_modulus * area,
          shear_modulus * torsion};
}

}  // namespace annulus
