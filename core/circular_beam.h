#pragma once

#include <cmath>

namespace annulus {

/// A beam of circular cross-section that bends and shears; SI.
struct CircularBeam {
  double diameter = 0;  ///< m
  double youngs_modulus = 0, poisson_ratio = 0;

  [[nodiscard]] double bending() const { return youngs_modulus * M_PI * std::pow(diameter, 4) / 64; }  ///< E I, N m^2
  /// kappa G A, N, with the shear coefficient of a circle kappa = 6 (1 + nu) / (7 + 6 nu) [Cowper1966].
  [[nodiscard]] double shear() const {
    const double kappa = 6 * (1 + poisson_ratio) / (7 + 6 * poisson_ratio);
    return kappa * youngs_modulus / (2 * (1 + poisson_ratio)) * M_PI * diameter * diameter / 4;
  }
  /// m/N: one end of a piece shifts against the other, and neither turns: L^3 / (12 E I) + L / (kappa G A).
  [[nodiscard]] double parallel_shift(double length) const {
    return std::pow(length, 3) / (12 * bending()) + length / shear();
  }
  /// m/N: the free end of a cantilever under a force there: L^3 / (3 E I) + L / (kappa G A).
  [[nodiscard]] double cantilever(double length) const {
    return std::pow(length, 3) / (3 * bending()) + length / shear();
  }
  /// rad/(N m): the free end of a cantilever under a moment there: L / (E I).
  [[nodiscard]] double cantilever_bend(double length) const { return length / bending(); }
  /// N m/rad: one end of a piece turns against the other, which is clamped, and does not shift.
  [[nodiscard]] double clamped_turn(double length) const {
    const double phi = 12 * bending() / (shear() * length * length);
    return (4 + phi) * bending() / ((1 + phi) * length);
  }
  /// N/m along its axis: E A / L.
  [[nodiscard]] double stretch(double length) const { return youngs_modulus * M_PI * diameter * diameter / 4 / length; }
  /// rad/N: L^2 / (2 E I).
  [[nodiscard]] double cantilever_tilt(double length) const { return length * length / (2 * bending()); }
};

}  // namespace annulus
