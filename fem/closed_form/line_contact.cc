#include "fem/closed_form/line_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/contact/contact_system.h"

namespace annulus::fem {
namespace {

/// The bracket of one body and its derivative by ln(b).
std::pair<double, double> bracket(const LineContact::Body& body, double b, double poisson_ratio) {
  const double nu = poisson_ratio, x = body.depth / b, root = std::hypot(1, x), shrink = 1 / (root + x);
  double value = std::asinh(x) - nu / (1 - nu) * x * shrink;
  double slope = -x / root + nu / (1 - nu) * x * shrink * (1 - x / root);
  const double range = LineContact::edge_range * b;
  if (body.edge < range) {
    const double d = body.edge + b / 2, y = body.depth / (2 * d), y2 = y * y, fade = 1 - body.edge / range;
    const double image = std::log1p(y2) / 2;
    value += fade * image;
    slope += body.edge / range * image - fade * y2 / (1 + y2) * b / (2 * d);
  }
  return {value, slope};
}

}  // namespace

LineContact::LineContact(double relative_curvature, const Body& planet, const Body& wheel, const Material& material,
                         double width)
    : curvature_(relative_curvature), width_(width), planet_(planet), wheel_(wheel), material_(material) {}

double LineContact::half_width(double force) const { return hertz_half_width(force / width_, curvature_, material_); }

double LineContact::peak_pressure(double force) const {
  return force > 0 ? 2 * force / width_ / (M_PI * half_width(force)) : 0;
}

double LineContact::approach(double force) const {
  if (force <= 0) return 0;
  const double nu = material_.poisson_ratio, b = half_width(force);
  return 2 * (1 - nu * nu) * force / width_ / (M_PI * material_.youngs_modulus) *
         (bracket(planet_, b, nu).first + bracket(wheel_, b, nu).first);
}

double LineContact::compliance(double force) const {
  const double nu = material_.poisson_ratio, b = half_width(force);
  const auto planet = bracket(planet_, b, nu), wheel = bracket(wheel_, b, nu);
  // The half-width grows with the root of the force: d ln(b) / d ln(F) = 1/2.
  return 2 * (1 - nu * nu) / width_ / (M_PI * material_.youngs_modulus) *
         (planet.first + wheel.first + (planet.second + wheel.second) / 2);
}

}  // namespace annulus::fem
