#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/bytes.h"
#include "fem/loaded_mesh.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

/// Two deformed bodies in mesh, near their contact: vertices and faces that are seen, in page axes (to the right,
/// upwards, to the eye). They are drawn as a picture, and by view3d.js as a view that can be rotated.
struct DeformedMesh {
  std::string name{};                                 ///< of the bodies, for readers
  std::vector<double> place_mm{}, displacement_mm{};  ///< three numbers a vertex
  std::vector<double> stress_MPa{};                   ///< von Mises, of every vertex
  std::vector<std::uint32_t> faces{};                 ///< four vertices each
  bool solid = false;                                 ///< not plane
  double largest_displacement_mm = 0, largest_stress_MPa = 0;
  double exaggeration = 1;  ///< of the displacements
  double top_MPa = 1;       ///< upper end of the colours: what only a few of the vertices exceed
  double mesh_phase = 0;
  int ring_tooth = 0;
};

/// Both bodies of a pair as they stand at this position, the pinion above the wheel. To the displacement of the pinion
/// belongs its rotation by the deflection of the mesh: where flanks touch, they touch at every exaggeration. Without
/// faces when a field has no cells.
[[nodiscard]] DeformedMesh deformed_mesh(const fem::BodyField& pinion, const fem::BodyField& wheel,
                                         const fem::LoadedPosition& position, const geometry::GearPair& pair,
                                         const std::string& name);

/// One scale for all views: up to the largest of their tops, rounded up.
void share_colours(const std::vector<DeformedMesh*>& views);

/// Displacements exaggerated, coloured by von Mises stress; grey: the outline of a plane body without load.
[[nodiscard]] std::string to_svg(const DeformedMesh& view);

/// As JSON for view3d.js, with the colours of its stress.
[[nodiscard]] nlohmann::json view_data(const DeformedMesh& view);

}  // namespace annulus::app

namespace annulus {

ANNULUS_MEMBERS(app::DeformedMesh, name, place_mm, displacement_mm, stress_MPa, faces, solid, largest_displacement_mm,
                largest_stress_MPa, exaggeration, top_MPa, mesh_phase, ring_tooth);

}  // namespace annulus
