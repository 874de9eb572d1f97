#include "fem/closed_form/contact_patch.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Flanks that tilt towards an end of the gap press the patch against it the more, the more it carries: the force grows
/// without limit at a certain width, here up to the inverse of this.
constexpr double stiffest = 1e-3;

/// Where a rising function crosses zero between `low` (negative) and `high` (positive), to rounding.
template <typename Function>
double crossing(const Function& f, double low, double high) {
  boost::math::tools::eps_tolerance<double> tolerance(50);
  std::uintmax_t iterations = 200;
  const auto [below, above] = boost::math::tools::toms748_solve(f, low, high, tolerance, iterations);
  return (below + above) / 2;
}

}  // namespace

ContactPatch::ContactPatch(const FlankGap& gap, double tilt, double effective_modulus)
    : gap_(gap),
      tilt_(tilt),
      stiffness_(M_PI * effective_modulus / 2),
      largest_((gap.high - gap.low) / 2),
      kinked_(gap.kinks[0].jump > 0 || gap.kinks[1].jump > 0) {
  require(largest_ > 0 && gap.curvature > 0, "a contact patch needs a convex gap, not the curvature ", gap.curvature,
          " 1/m under up to ", largest_, " N/m");
  find_borders();
}

void ContactPatch::find_borders() {
  const auto touched = [&](double a) {
    const State state = at(a);
    int code = state.cut;
    for (std::size_t i = 0; i < gap_.kinks.size(); ++i)
      if (gap_.kinks[i].jump > 0 && std::abs(gap_.kinks[i].place - state.middle) < a) code += 4 << i;
    return code;
  };
  constexpr int samples = 32;
  constexpr double finest = 1e-4;
  double last = finest * largest_;
  int code = touched(last);
  for (int i = 1; i <= samples; ++i) {
    const double next = largest_ * std::pow(finest, 1 - static_cast<double>(i) / samples);
    const int next_code = touched(next);
    // Several borders may lie between two samples; a kink at an end of the gap is in and out by rounding.
    constexpr int most = 6;
    for (int found = 0; code != next_code && found < most; ++found) {
      double low = last, high = next;
      while (high - low > 1e-12 * high) {
        const double middle = (low + high) / 2;
        (touched(middle) == code ? low : high) = middle;
      }
      borders_.push_back(high);
      last = high, code = touched(high);
    }
    last = next, code = next_code;
  }
}

double ContactPatch::mean_slope(double a, double c) const {
  double sum = gap_.slope + gap_.curvature * c;
  for (const auto& kink : gap_.kinks)
    if (kink.jump > 0) sum += kink.jump * std::acos(std::clamp((kink.place - c) / a, -1.0, 1.0)) / M_PI;
  return sum;
}

double ContactPatch::moment(double a, double c) const {
  double sum = gap_.curvature * a * a / 2;
  for (const auto& kink : gap_.kinks) {
    const double place = (kink.place - c) / a;
    if (kink.jump > 0 && std::abs(place) < 1) sum += kink.jump * a * std::sqrt(1 - place * place) / M_PI;
  }
  return sum;
}

ContactPatch::State ContactPatch::at(double a) const {
  const double lowest = gap_.low + a, highest = gap_.high - a;
  // Free patches: what the slope amounts to if the patch is there.
  const auto slope = [&](double c) { return mean_slope(a, c) + tilt_ * stiffness_ * moment(a, c); };
  const auto cut = [&](double c, int side) {
    const double m = moment(a, c), s = -side * mean_slope(a, c);
    return State{c, stiffness_ * (m + a * s) / std::max(1 + side * stiffness_ * a * tilt_, stiffest), side};
  };
  if (slope(lowest) >= 0) return cut(lowest, -1);
  if (slope(highest) <= 0) return cut(highest, 1);
  const double c =
      kinked_ ? crossing(slope, lowest, highest) : -(gap_.slope + tilt_ * stiffness_ * moment(a, 0)) / gap_.curvature;
  return {c, stiffness_ * moment(a, c), 0};
}

double ContactPatch::half_width(double line_load) const {
  if (line_load <= 0) return 0;
  const auto excess = [&](double a) { return (a > 0 ? at(a).line_load : 0) - line_load; };
  // Curvature alone would take more width: Hertz.
  const double most = std::min(largest_, 1.000001 * std::sqrt(2 * line_load / (stiffness_ * gap_.curvature)));
  if (excess(most) <= 0) return most;
  return crossing(excess, 0.0, most);
}

}  // namespace annulus::fem
