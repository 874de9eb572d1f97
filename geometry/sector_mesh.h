#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace annulus::geometry {

/// The body under the teeth.
struct Rim {
  double support_radius = 0;      ///< m: bore radius (external) or outside radius (internal)
  std::vector<double> circles{};  ///< m: radii inside the rim that have to be mesh lines (a sleeve's inside radius)
};

/// Cell counts of the structured tooth sector.
struct SectorResolution {
  int flank_cells = 40;      ///< along each involute flank, uniform in arc length
  int fillet_cells = 6;      ///< along each fillet, even, at least 2
  int thickness_cells = 14;  ///< across the tooth
  int root_cells = 3;        ///< along the root land on each side
  int rim_cells = 6;         ///< from the root to the support
  /// Thickness of the first cell under both flanks relative to a uniform split (1 = uniform, 0.1 = strongly graded).
  double flank_layer = 0.5;  ///< in (0, 1]
};

/// Distance that every mesh circle keeps from the root circle, modules: between them the rim's cells have to follow the
/// root fillets.
inline constexpr double min_circle_distance = 0.1;

/// One tooth sector between the mid-space radial cuts, meshed by gmsh with structured quadrilaterals; the vertices of
/// `side_low` and `side_high` match under rotation by one pitch. Regions: tooth (down to a line between the middles of
/// the two fillets) and rim. Throws GeometryError when the rim does not exist (ring thinner than its teeth, bore above
/// the root), a circle lies outside it or nearer than `min_circle_distance` to the root, or the support is nearer than
/// that.
[[nodiscard]] Mesh make_sector_mesh(const Gear& gear, const Rim& rim, const SectorResolution& resolution);

}  // namespace annulus::geometry
