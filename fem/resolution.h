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

/// Levels of resolution: every level has cells 1.5 times smaller than the one before, in the plane; results come from
/// one level, their error estimate from the difference to the level before.
inline constexpr double level_ratio = 1.5;
inline constexpr int most_flank_cells = 900;
inline constexpr int last_solid_level = 2;

/// Plane cross-section that resolves the contact. At level 1 the flank cells are a sixth of `half_width` (Hertz,
/// nominal load), so that a quarter of the load still has three cells in its half-width; at light loads level 1 has 120
/// cells along the flank. A level beyond last_contact_level() is refused.
[[nodiscard]] BodyResolution contact_resolution(const geometry::Gear& gear, double half_width, int level);
/// The last level whose flank has no more than `most_flank_cells`: levels beyond would not differ.
[[nodiscard]] int last_contact_level(const geometry::Gear& gear, double half_width);
/// Solid body: the flank is coarse, its near field is corrected from the plane.
[[nodiscard]] BodyResolution solid_resolution(int level);

}  // namespace annulus::fem
