#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "fem/problem/material.h"

namespace annulus::fem {

/// Gauss-Chebyshev points of the second kind: place (of the half-length) and share of a semi-elliptic load, with the
/// weight (2 / pi) sqrt(1 - t^2) over [-1, 1].
template <std::size_t count>
std::array<std::pair<double, double>, count> semi_ellipse_points() {
  std::array<std::pair<double, double>, count> points;
  constexpr double intervals = static_cast<double>(count) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = static_cast<double>(i + 1) * M_PI / intervals, sine = std::sin(angle);
    points[i] = {std::cos(angle), 2 * sine * sine / intervals};
  }
  return points;
}

/// Surface displacement of an elastic half-plane (plane strain) under normal loads, into the material, m per N/m of
/// line load: u(x) = -2 (1 - nu^2) / (pi E) * integral of p(s) ln|x - s| ds [Johnson1985, sec. 2.3].
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
