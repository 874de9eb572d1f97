#include "dynamics/system/curve_bundle.h"

#include <cmath>
#include <numeric>

#include "core/errors.h"

namespace annulus::dynamics {

CurveBundle::CurveBundle(const std::vector<const PeriodicCurve*>& curves) : width_(static_cast<int>(curves.size())) {
  int period = 1, per_cycle = 1;
  for (const auto* curve : curves) {
    period = std::lcm(period, static_cast<int>(std::lround(curve->period())));
    per_cycle = std::lcm(per_cycle, curve->pieces_per_unit());
  }
  const int pieces = period * per_cycle;
  grid_ = PhaseGrid(period, pieces);
  coefficients_.resize(static_cast<std::size_t>(pieces) * 4 * curves.size());
  auto* out = coefficients_.data();
  for (int piece = 0; piece < pieces; ++piece, out += 4 * curves.size())
    for (std::size_t i = 0; i < curves.size(); ++i) {
      // The curve's own piece, its polynomial expanded about the start of this part of it.
      const int parts = per_cycle / curves[i]->pieces_per_unit();
      const auto c = curves[i]->coefficients(piece / parts % curves[i]->pieces());
      const double scale = 1.0 / parts, a = (piece % parts) * scale;
      out[i] = c[0] + a * (c[1] + a * (c[2] + a * c[3]));
      out[curves.size() + i] = scale * (c[1] + a * (2 * c[2] + 3 * a * c[3]));
      out[2 * curves.size() + i] = scale * scale * (c[2] + 3 * a * c[3]);
      out[3 * curves.size() + i] = scale * scale * scale * c[3];
    }
}

void CurveBundle::evaluate(double cycles, double* values, double* derivatives) const {
  const auto [index, x] = grid_.locate(cycles);
  const double *c0 = piece(index), *c1 = c0 + width_, *c2 = c1 + width_, *c3 = c2 + width_;
  for (int i = 0; i < width_; ++i) values[i] = c0[i] + x * (c1[i] + x * (c2[i] + x * c3[i]));
  const double rate = grid_.rate();
  for (int i = 0; i < width_; ++i) derivatives[i] = rate * (c1[i] + x * (2 * c2[i] + 3 * x * c3[i]));
}

}  // namespace annulus::dynamics
