#pragma once

#include "fem/problem/loaded_mesh_problem.h"
#include "geometry/sector_mesh.h"

namespace annulus::fem {

/// Cell counts of one gear of a loaded mesh, plane cross-section and axial direction.
struct BodyResolution {
  geometry::SectorResolution section;
  int face_cells = 0;    ///< along the face width (solid only)
  int sleeve_cells = 0;  ///< along the free length of a sleeve
};

/// Levels of resolution: every level has cells 1.5 times smaller than the one before, and grades them more gently (of
/// quadratic solids 1.2 times across the rim, where the error falls fastest, up to 1.7 times along a sleeve);
/// results come from one level, their error estimate from the difference to the level before. The plane starts at level
/// 0 and ends at `last_plane_level`.
inline constexpr double level_ratio = 1.5;
inline constexpr int last_plane_level = 6;
inline constexpr int last_solid_level = 2;

/// Plane cross-section. The load does not enter: what the flank's cells cannot resolve of a contact comes from the
/// half-plane (see ContactBody). That needs smaller cells only near the ends of the flank, where the half-plane is no
/// model: they shrink in proportion to the distance from the end, down to a thirtieth at the tip.
[[nodiscard]] BodyResolution plane_resolution(const geometry::Gear& gear, int level, int degree = 2);
/// Where and how finely a flank is meshed for one contact, arc lengths from the involute's start on the base circle,
/// s = rho^2 / (2 r_b).
struct ContactCells {
  double centre = 0;          ///< m
  double reach = 0;           ///< m, to either side of the centre: cells of `cell`
  double cell = 0;            ///< m
  double growth = 1;          ///< from cell to cell, away from there
  std::vector<double> edges;  ///< m: places under which a tip edge of either tooth presses, with infinite pressure
  double at_edge = 0;         ///< m, length of the cells there
};
/// Section whose flank is meshed for one contact, as thin under the flank as along it. Counts that cyclic interfaces
/// depend on are those of `regular`.
[[nodiscard]] geometry::SectorResolution resolving_section(const geometry::Gear& gear,
                                                           const geometry::SectorResolution& regular,
                                                           const ContactCells& contact);
/// Solid body: the flank is coarse, its near field is corrected from the plane. `overlap_ratio` of helical teeth, along
/// which the contact moves over their height.
[[nodiscard]] BodyResolution solid_resolution(int level, int degree, double overlap_ratio = 0);
/// In how many slices, along the face, of constant pressure a cell of a solid is divided.
[[nodiscard]] int slices_per_cell(const LoadedMeshProblem& problem, int degree);
/// Slices of a single support on the outside of a solid ring, each unilateral on its own: one per layer of elements. A
/// helical ring, which cannot tilt, spreads its load too evenly along the axis for more than four to matter.
[[nodiscard]] int support_slices(const LoadedMeshProblem& problem, int face_cells);
/// Pressure elements of a contact to either side of its centre; in a solid, in every slice. Linear helical teeth, with
/// their many slices, leave so much that fewer of them do.
[[nodiscard]] int pressure_elements(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level);
/// Solid body of the resolved model, away from its contacts.
[[nodiscard]] BodyResolution resolved_solid_resolution(int level);

}  // namespace annulus::fem
