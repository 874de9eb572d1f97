#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elasticity/nodal_load.h"
#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// A unit force spread over an arc of the outside of a ring and over a slice of its width, seen by one sector.
struct ArcLoad {
  double centre = 0;      ///< rad, polar angle of the middle in the sector's frame, may lie beyond its interfaces
  double half_arc = 0;    ///< rad
  double direction = 0;   ///< rad, of the force, polar angle in the sector's frame
  bool parabolic = true;  ///< density 3/4 (1 - x^2) over x in [-1, 1]; else uniform
  double z_low = 0, z_high = 0;  ///< m, of a solid ring: uniform between them
};

/// The part of the load that lies on the sector's own outside.
[[nodiscard]] NodalLoad on_outside(const ArcLoad& arc, const TraceGrid& outside);

/// The loads that arcs are put together from, wherever they lie: at every station of the outside and in every slice of
/// the width a unit force along x and one along y. A sector condensed for them serves all supports with these slices,
/// exactly.
struct OutsideLoads {
  int degree = 2;
  std::vector<double> stations;           ///< rad, ascending
  std::vector<double> z_low{}, z_high{};  ///< m, of the slices, ascending

  /// The slices are those of the arcs.
  [[nodiscard]] static OutsideLoads of(const std::vector<ArcLoad>& arcs, const TraceGrid& outside);

  [[nodiscard]] int size() const { return 2 * static_cast<int>(stations.size() * z_low.size()); }
  /// [station][slice][x, y]
  [[nodiscard]] std::vector<NodalLoad> unit_loads(const TraceGrid& outside) const;
  /// How arcs are put together: size() x arcs.
  [[nodiscard]] Eigen::MatrixXd weights(const std::vector<ArcLoad>& arcs) const;
};

}  // namespace annulus::fem
