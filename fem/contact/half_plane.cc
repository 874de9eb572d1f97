#include "fem/contact/half_plane.h"

#include <cmath>
#include <utility>

namespace annulus::fem {
namespace {

/// Second antiderivative of ln|t|.
double twice_integrated_log(double t) {
  const double size = std::abs(t);
  return size > 0 ? size * size * (std::log(size) / 2 - 0.75) : 0;
}

/// Integral of (2 / pi) sqrt(1 - s^2) ln|x - s| over [-1, 1].
double log_potential(double x) {
  const double size = std::abs(x);
  const double inside = x * x - 0.5 - std::log(2.0);
  if (size <= 1) return inside;
  const double root = std::sqrt((size - 1) * (size + 1));
  // x^2 - x sqrt(x^2 - 1) without cancellation.
  return size / (size + root) - 0.5 - std::log(2.0) + std::log(size + root);
}

}  // namespace

HalfPlane::HalfPlane(const Material& material)
    : factor_(-2 * (1 - material.poisson_ratio * material.poisson_ratio) / (M_PI * material.youngs_modulus)) {}

double HalfPlane::strips(double distance, double half_a, double half_b) const {
  // Far apart the four terms cancel; the mean of the logarithm is then that of its Taylor series.
  const double larger = std::max(half_a, half_b);
  if (std::abs(distance) > 300 * larger)
    return factor_ * (std::log(std::abs(distance)) - (half_a * half_a + half_b * half_b) / (6 * distance * distance));
  const double sum = half_a + half_b, difference = half_a - half_b;
  return factor_ *
         (twice_integrated_log(distance + sum) - twice_integrated_log(distance + difference) -
          twice_integrated_log(distance - difference) + twice_integrated_log(distance - sum)) /
         (4 * half_a * half_b);
}

double HalfPlane::semi_ellipses(double distance, double half_a, double half_b) const {
  if (half_a > half_b) std::swap(half_a, half_b);
  // Gauss quadrature with the weight sqrt(1 - t^2) over the narrower one, in the potential of the wider one.
  static const auto points = semi_ellipse_points<12>();
  double mean = 0;
  for (const auto& [place, weight] : points) mean += weight * log_potential((distance + half_a * place) / half_b);
  return factor_ * (mean + std::log(half_b));
}

}  // namespace annulus::fem
