#pragma once

#include "fem/loaded_mesh.h"
#include "geometry/sector_mesh.h"

namespace annulus::fem {

/// Cell counts of one gear of a loaded mesh, plane cross-section and axial direction.
struct BodyResolution {
  geometry::SectorResolution section;
  int face_cells = 0;    ///< along the face width (solid only)
  int sleeve_cells = 0;  ///< along the free length of a sleeve
};

/// How fine: `reported` is what the results are taken from, `check` the coarser companion of the error estimate.
enum class Level { reported, check };

/// Ratio of the cell sizes of the two levels in the plane.
inline constexpr double level_ratio = 1.5;

/// Plane cross-section that resolves the contact: flank cells of a sixth of `half_width` (Hertz, nominal load), so that
/// a quarter of the load still has three cells in its half-width.
[[nodiscard]] BodyResolution contact_resolution(const geometry::Gear& gear, double half_width, double accuracy,
                                                Level level);
/// Solid body: the flank is coarse, its near field is corrected from the plane.
[[nodiscard]] BodyResolution solid_resolution(Level level);

}  // namespace annulus::fem
