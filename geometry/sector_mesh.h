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
  int flank_cells = 40;      ///< along each involute flank, uniform in arc length (when `flank_fractions` is empty)
  int fillet_cells = 6;      ///< along each fillet, even, at least 2
  int thickness_cells = 14;  ///< across the tooth
  int root_cells = 3;        ///< along the root land on each side
  int rim_cells = 6;         ///< from the root to the support
  /// Thickness of the first cell under both flanks relative to a uniform split (1 = uniform), in [0.001, 1]. From it
  /// the cells grow geometrically to the middle of the tooth with the ratio that fills the thickness: with 40 cells
  /// 1.15 for 0.2, 1.34 for 0.02, 1.60 for 0.001. Curved elements need a first layer thicker than the bulge L^2 / (8 R)
  /// of the edges over it, L being the length of a flank or fillet edge and R its radius of curvature.
  double flank_layer = 0.5;
  /// Vertices of both flanks as fractions of the arc length, 0 at the form circle, 1 at the tip, strictly increasing
  /// from 0 to 1 (`flank_cells` does not count then). They lie on the exact involute. The vertices on the radial cuts
  /// depend on `rim_cells` and `thickness_cells` only: sectors that differ in the rest fit together.
  std::vector<double> flank_fractions{};
};

/// Distance that every mesh circle keeps from the root circle, modules: between them the rim's cells have to follow the
/// root fillets.
inline constexpr double min_circle_distance = 0.1;

/// Smallest `SectorResolution::flank_layer`.
inline constexpr double min_flank_layer = 1e-3;

/// One tooth sector between the mid-space radial cuts, meshed by gmsh with structured quadrilaterals; the vertices of
/// `side_low` and `side_high` match under rotation by one pitch. Regions: tooth (down to a line between the middles of
/// the two fillets) and rim. Throws GeometryError when the rim does not exist (ring thinner than its teeth, bore above
/// the root), a circle lies outside it or nearer than `min_circle_distance` to the root, or the support is nearer than
/// that.
[[nodiscard]] Mesh make_sector_mesh(const Gear& gear, const Rim& rim, const SectorResolution& resolution);

}  // namespace annulus::geometry
