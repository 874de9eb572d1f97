#include "benchmarks/calculix/support_arc.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "benchmarks/calculix/deck.h"

namespace annulus::benchmarks {

std::map<int, double> support_shares(const QuadraticBody& body, const fem::SupportSite& arc) {
  std::map<int, double> result;
  constexpr std::array<std::pair<double, double>, 3> gauss{
      {{-0.774596669241483, 5.0 / 9}, {0, 8.0 / 9}, {0.774596669241483, 5.0 / 9}}};
  for (const auto& side : body.sides) {
    if (side.boundary != geometry::Boundary::support) continue;
    const auto& cell = body.cells[side.cell];
    const std::array<int, 3> nodes{cell[side.number], cell[4 + side.number], cell[(side.number + 1) % 4]};
    const auto angle = [&](int node) {
      const auto& p = body.nodes[node];
      return std::remainder(std::atan2(p.y(), p.x()) - arc.angle, 2 * std::numbers::pi);
    };
    const double from = angle(nodes[0]), to = angle(nodes[2]);
    if (std::abs(to - from) > 1) continue;  // the side opposite to the arc, where angles jump
    const double low = std::max(std::min(from, to), -arc.half_arc), high = std::min(std::max(from, to), arc.half_arc);
    if (high <= low) continue;
    for (const auto& [place, weight] : gauss) {
      const double t = (low + high + (high - low) * place) / 2, x = t / arc.half_arc;
      const double share = (arc.parabolic ? 0.75 * (1 - x * x) : 0.5) * weight * (high - low) / 2 / arc.half_arc;
      const double u = 2 * (t - from) / (to - from) - 1;
      result[nodes[0]] += share * u * (u - 1) / 2;
      result[nodes[1]] += share * (1 - u * u);
      result[nodes[2]] += share * u * (u + 1) / 2;
    }
  }
  return result;
}

void write_mean_displacement(fmt::ostream& out, const DeckBody& body, const fem::SupportSite& arc, double angle,
                             int reference, int component) {
  DeckEquation equation;
  equation.push_back({reference, component, -1});
  for (const auto& [node, share] : support_shares(body.body, arc)) {
    equation.push_back({body.first_node + node + 1, 1, share * std::cos(angle)});
    equation.push_back({body.first_node + node + 1, 2, share * std::sin(angle)});
  }
  write_equation(out, equation);
}

}  // namespace annulus::benchmarks
