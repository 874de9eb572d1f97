#pragma once

#include "app/plan/gear_geometry.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// Bodies that have to be meshed need a rim: bores stay below the roots, outside diameters, sleeves and flanges beyond
/// them. Throws GeometryError, starting with the key, where a mesh is computed whose bodies have none.
void check_rims(const Scene& scene, const GearGeometry& geometry);

/// Refuses loads, supports and errors too large for small displacements (small_displacements.h). Throws InputError.
void check_displacements(const Scene& scene, const GearGeometry& geometry);

}  // namespace annulus::app
