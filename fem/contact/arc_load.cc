#include "fem/contact/arc_load.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "fem/contact/trace_basis.h"

namespace annulus::fem {

NodalLoad on_outside(const ArcLoad& arc, const TraceGrid& outside) {
  const TraceBasis basis(outside.profile, outside.degree);
  std::vector<double> over_arc(outside.profile.size(), 0.0);
  for (int e = 0; e < basis.elements(); ++e) {
    const double a = std::max(outside.profile[e * outside.degree], arc.centre - arc.half_arc);
    const double b = std::min(outside.profile[(e + 1) * outside.degree], arc.centre + arc.half_arc);
    if (b <= a) continue;
    using Rule = boost::math::quadrature::gauss<double, 7>;
    const auto add = [&](double abscissa, double weight) {
      const double angle = (a + b) / 2 + abscissa * (b - a) / 2, x = (angle - arc.centre) / arc.half_arc;
      const double density = arc.parabolic ? 0.75 * (1 - x * x) : 0.5;
      const auto values = basis(angle);
      for (std::size_t i = 0; i < values.weights.size(); ++i)
        over_arc[values.first + i] += density * weight * (b - a) / 2 / arc.half_arc * values.weights[i];
    };
    for (std::size_t q = 0; q < Rule::abscissa().size(); ++q) {
      add(Rule::abscissa()[q], Rule::weights()[q]);
      if (Rule::abscissa()[q] != 0) add(-Rule::abscissa()[q], Rule::weights()[q]);
    }
  }
  std::vector<double> over_width = {1.0};
  if (outside.axial.size() > 1) over_width = TraceBasis(outside.axial, outside.degree).mean_over(arc.z_low, arc.z_high);

  const Eigen::Vector3d direction(std::cos(arc.direction), std::sin(arc.direction), 0);
  NodalLoad load;
  for (std::size_t u = 0; u < over_arc.size(); ++u)
    for (std::size_t z = 0; z < over_width.size(); ++z) {
      const double weight = over_arc[u] * over_width[z];
      if (weight != 0) load.push_back({outside.nodes[u * over_width.size() + z], weight * direction});
    }
  return load;
}

}  // namespace annulus::fem
