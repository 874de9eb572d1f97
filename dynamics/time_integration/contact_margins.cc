#include "dynamics/time_integration/contact_margins.h"

#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace annulus::dynamics {

namespace {

using Bezier = std::array<double, 4>;

/// Of a curve that only falls, from 0 or above to below.
double zero_of(const Bezier& p) {
  const auto value = [&p](double x) {
    const double y = 1 - x;
    return y * y * (y * p[0] + 3 * x * p[1]) + x * x * (3 * y * p[2] + x * p[3]);
  };
  std::uintmax_t iterations = 50;
  const auto [low, high] = boost::math::tools::toms748_solve(value, 0.0, 1.0, p.front(), p.back(),
                                                             boost::math::tools::eps_tolerance<double>(30), iterations);
  return high;
}

/// Of control points between two places; a curve stays within their hull.
std::optional<double> descent_of(const Bezier& points, double low, double high) {
  const auto [a, b, c, d] = points;
  if (a >= 0 && b >= 0 && c >= 0 && d >= 0) return std::nullopt;
  if (a < 0) return low;
  if (a >= b && b >= c && c >= d) return low + zero_of(points) * (high - low);
  constexpr double fine = 1e-9;
  if (high - low < fine) return d < 0 ? std::optional(high) : std::nullopt;
  const double ab = (a + b) / 2, bc = (b + c) / 2, cd = (c + d) / 2;
  const double abc = (ab + bc) / 2, bcd = (bc + cd) / 2, middle = (abc + bcd) / 2;
  const double half = (low + high) / 2;
  if (const auto left = descent_of({a, ab, abc, middle}, low, half)) return left;
  return descent_of({middle, bcd, cd, d}, half, high);
}

}  // namespace

ContactMargins contact_margins(const LumpedSystem& system, int mesh, double slack,
                               const LumpedSystem::Workspace& workspace) {
  const auto m = static_cast<std::size_t>(mesh);
  const double half = *system.meshes()[m].half_backlash;
  const double delta = workspace.delta[m], rate = workspace.delta_rate[m];
  switch (workspace.contact[m]) {
    case LumpedSystem::Contact::drive:
      return {.drive = {delta - half + slack, rate}, .back = {}};
    case LumpedSystem::Contact::back:
      return {.drive = {}, .back = {-half - delta + slack, -rate}};
    case LumpedSystem::Contact::open:
      break;
  }
  return {.drive = {half - delta + slack, -rate}, .back = {delta + half + slack, rate}};
}

std::optional<double> first_descent(double begin, double begin_slope, double end, double end_slope) {
  return descent_of({begin, begin + begin_slope / 3, end - end_slope / 3, end}, 0, 1);
}

}  // namespace annulus::dynamics
