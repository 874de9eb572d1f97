#include "fem/elasticity/arc_load.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/errors.h"
#include "fem/elasticity/trace_basis.h"

namespace annulus::fem {

namespace {

/// Shares of the stations of the outside in the load.
std::vector<double> over_stations(const ArcLoad& arc, const std::vector<double>& stations, int degree) {
  const TraceBasis basis(stations, degree);
  std::vector<double> over_arc(stations.size(), 0.0);
  basis.for_gauss_points(
      arc.centre - arc.half_arc, arc.centre + arc.half_arc, [&](double angle, double weight, double length) {
        const double x = (angle - arc.centre) / arc.half_arc;
        const double density = arc.parabolic ? 0.75 * (1 - x * x) : 0.5;
        const auto values = basis(angle);
        for (std::size_t i = 0; i < values.weights.size(); ++i)
          over_arc[values.first + i] += density * weight * length / 2 / arc.half_arc * values.weights[i];
      });
  return over_arc;
}

/// Shares of the axial stations in a load that is even over a slice; one share in the plane.
std::vector<double> over_slice(const TraceGrid& outside, double z_low, double z_high) {
  if (outside.axial.size() == 1) return {1.0};
  return TraceBasis(outside.axial, outside.degree).mean_over(z_low, z_high);
}

Eigen::Vector3d unit_force(const ArcLoad& arc) { return {std::cos(arc.direction), std::sin(arc.direction), 0}; }

}  // namespace

NodalLoad on_outside(const ArcLoad& arc, const TraceGrid& outside) {
  const auto over_arc = over_stations(arc, outside.profile, outside.degree);
  const auto over_width = over_slice(outside, arc.z_low, arc.z_high);
  NodalLoad load;
  for (std::size_t u = 0; u < over_arc.size(); ++u)
    for (std::size_t z = 0; z < over_width.size(); ++z) {
      const double weight = over_arc[u] * over_width[z];
      if (weight != 0) load.push_back({outside.nodes[u * over_width.size() + z], weight * unit_force(arc)});
    }
  return load;
}

OutsideLoads OutsideLoads::of(const std::vector<ArcLoad>& arcs, const TraceGrid& outside) {
  OutsideLoads loads{outside.degree, outside.profile};
  std::set<std::pair<double, double>> slices;
  for (const auto& arc : arcs) slices.emplace(arc.z_low, arc.z_high);
  for (const auto& [low, high] : slices) {
    loads.z_low.push_back(low);
    loads.z_high.push_back(high);
  }
  return loads;
}

std::vector<NodalLoad> OutsideLoads::unit_loads(const TraceGrid& outside) const {
  std::vector<NodalLoad> loads;
  for (std::size_t u = 0; u < stations.size(); ++u)
    for (std::size_t slice = 0; slice < z_low.size(); ++slice)
      for (const auto& direction : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()}) {
        const auto over_width = over_slice(outside, z_low[slice], z_high[slice]);
        auto& load = loads.emplace_back();
        for (std::size_t z = 0; z < over_width.size(); ++z)
          if (over_width[z] != 0)
            load.push_back({outside.nodes[u * over_width.size() + z], over_width[z] * Eigen::Vector3d(direction)});
      }
  return loads;
}

Eigen::MatrixXd OutsideLoads::weights(const std::vector<ArcLoad>& arcs) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size(), static_cast<Eigen::Index>(arcs.size()));
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    const auto& arc = arcs[a];
    const auto slice = std::find(z_low.begin(), z_low.end(), arc.z_low) - z_low.begin();
    require(slice < static_cast<std::ptrdiff_t>(z_low.size()) && z_high[slice] == arc.z_high,
            "an arc load over a slice that the sector was not condensed for");
    const auto over_arc = over_stations(arc, stations, degree);
    const auto force = unit_force(arc);
    for (std::size_t u = 0; u < over_arc.size(); ++u)
      result.col(static_cast<Eigen::Index>(a)).segment<2>(2 * (static_cast<Eigen::Index>(u * z_low.size()) + slice)) =
          over_arc[u] * force.head<2>();
  }
  return result;
}

}  // namespace annulus::fem
