#include "fem/closed_form/line_contact.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>
#include <vector>

namespace annulus::fem {
namespace {

/// 2 (1 - nu^2) / (pi E) of one body, m per N/m.
double local_compliance(const Material& m) {
  return 2 * (1 - m.poisson_ratio * m.poisson_ratio) / (M_PI * m.youngs_modulus);
}

/// B of a half space and its derivative by ln(a).
std::pair<double, double> half_space(double depth, double a, double poisson_ratio) {
  const double n = poisson_ratio / (1 - poisson_ratio), x = depth / a, r = std::hypot(1, x), s = r + x;
  const double value = std::asinh(x) - n * x / s;
  const double slope = -x / r + n * x / (r * s * s);
  const double curvature =
      x / (r * r * r) - n * x * (1 / r - x * x / (r * r * r) - 2 * x / (r * r)) / (s * s);  // -x d slope / dx
  return {value + slope / 2, slope + curvature / 2};
}

/// What the corner of a tooth yields more than a half plane under a load normal to its flank.
double wedge(double corner) {
  const double alpha = corner / 2, c = std::cos(alpha), s = std::sin(alpha);
  return M_PI / 2 * (c * c / (alpha - s * c) + s * s / (alpha + s * c)) - 1;
}

/// Part of the corner in B and its derivative by the distance d.
std::pair<double, double> edge_part(double k, double depth, double d) {
  const double y = LineContact::edge_reach * depth / d, y2 = y * y;
  return {k * std::log1p(y2) / 2, -k * y2 / (1 + y2) / d};
}

}  // namespace

LineContact::LineContact(const FlankGap& gap, const Body& pinion, const Body& wheel, double tilt,
                         const MeshMaterials& materials, double width)
    : patch_(gap, tilt, materials.contact_modulus()),
      tilt_(tilt),
      width_(width),
      pinion_(pinion),
      wheel_(wheel),
      pinion_wedge_(wedge(pinion.corner)),
      wheel_wedge_(wedge(wheel.corner)),
      materials_(materials) {}

double LineContact::peak_pressure(const State& state, double force) const {
  return 2 * force / width_ / (M_PI * state.half_width);
}

LineContact::Increment LineContact::increment(double a, double middle, double middle_slope) const {
  const double on_pinion = local_compliance(materials_.pinion), on_wheel = local_compliance(materials_.wheel);
  const auto pinion = half_space(pinion_.depth, a, materials_.pinion.poisson_ratio),
             wheel = half_space(wheel_.depth, a, materials_.wheel.poisson_ratio);
  Increment sum{on_pinion * pinion.first + on_wheel * wheel.first,
                (on_pinion * pinion.second + on_wheel * wheel.second) / a};
  if (std::isfinite(pinion_.edge)) {
    const auto [value, slope] = edge_part(pinion_wedge_, pinion_.depth, pinion_.edge - middle);
    sum.value += on_pinion * value, sum.slope -= on_pinion * slope * middle_slope;
  }
  if (std::isfinite(wheel_.edge)) {
    const auto [value, slope] = edge_part(wheel_wedge_, wheel_.depth, wheel_.edge + middle);
    sum.value += on_wheel * value, sum.slope += on_wheel * slope * middle_slope;
  }
  return sum;
}

LineContact::State LineContact::at(double force) const {
  const double line_load = force / width_, modulus = materials_.contact_modulus();
  const double moved = M_PI * modulus / 4 * tilt_ * tilt_;
  const double a = patch_.half_width(line_load);
  const auto patch = patch_.at(a);
  State state;
  state.half_width = a;
  state.middle = patch.middle;
  const double to_edge = patch.cut > 0 ? pinion_.edge - patch.middle : wheel_.edge + patch.middle;
  state.at_tip_edge = patch.cut != 0 && to_edge < a * (1 + 1e-6);
  const double last = increment(a, patch.middle, 0).value + 2 * tilt_ * patch.middle - moved * a * a;
  state.compliance = last / width_;

  // By parts: int y(a) dF' = y F' - int F' y'(a) da, piece by piece.
  const auto rest = [&](double x) {
    const auto now = patch_.at(x);
    constexpr double step = 1e-5;
    const double moves = now.cut != 0
                             ? -now.cut
                             : (patch_.at(x * (1 + step)).middle - patch_.at(x * (1 - step)).middle) / (2 * step * x);
    return now.line_load * (increment(x, now.middle, moves).slope + 2 * tilt_ * moves - 2 * moved * x);
  };
  state.approach = last * line_load;
  double from = 0;
  const auto piece = [&](double to) {
    if (to > from) state.approach -= boost::math::quadrature::gauss<double, 10>::integrate(rest, from, to);
    from = std::max(from, to);
  };
  for (const double border : patch_.borders()) piece(std::min(border, a));
  piece(a);
  return state;
}

}  // namespace annulus::fem
