#pragma once

#include "fem/problem/material.h"

namespace annulus::fem {

/// Surface displacement of an elastic half-plane (plane strain) under normal loads, into the material, m per N/m of
/// line load: u(x) = -2 (1 - nu^2) / (pi E) * integral of p(s) ln|x - s| ds (Johnson, Contact Mechanics, 2.3).
/// Determined up to one constant: only differences of loads with the same resultant mean something.
class HalfPlane {
 public:
  explicit HalfPlane(const Material& material);

  /// Mean over a strip (half-length `half_a`) under a unit load spread evenly over another, centres `distance` apart,
  /// m.
  [[nodiscard]] double strips(double distance, double half_a, double half_b) const;
  /// The same for loads and means that are semi-elliptical over the strips.
  [[nodiscard]] double semi_ellipses(double distance, double half_a, double half_b) const;

 private:
  double factor_;
};

}  // namespace annulus::fem
