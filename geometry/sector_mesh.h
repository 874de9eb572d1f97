#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace annulus::geometry {

/// The body under the teeth.
struct Rim {
  double support_radius = 0;    ///< m: bore radius (external) or outside radius (internal)
  std::vector<double> circles;  ///< m: radii inside the rim that have to be mesh lines (a sleeve's inside radius)
};

/// Cell counts of the structured tooth sector.
struct SectorResolution {
  int flank_cells = 40;      ///< along each involute flank, uniform in arc length
  int fillet_cells = 6;      ///< along each fillet (even)
  int thickness_cells = 14;  ///< across the tooth
  int root_cells = 3;        ///< along the root land on each side
  int rim_cells = 6;         ///< from the root to the support
  /// Thickness of the first cell under both flanks relative to a uniform split (1 = uniform, 0.1 = strongly graded).
  double flank_layer = 0.5;
};

/// One tooth sector between the mid-space radial cuts, meshed by gmsh with structured quadrilaterals; the vertices of
/// `side_low` and `side_high` match under rotation by one pitch. Throws GeometryError when the rim does not exist
/// (ring thinner than its teeth, bore above the root).
[[nodiscard]] Mesh make_sector_mesh(const Gear& gear, const Rim& rim, const SectorResolution& resolution);

}  // namespace annulus::geometry
