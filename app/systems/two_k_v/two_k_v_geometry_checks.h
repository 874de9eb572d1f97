#pragma once

#include "app/scene/scene.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

/// Bores of the sun and of a planet stay below the roots. Throws GeometryError, starting with the key, where their mesh
/// is computed.
void check_rims(const Scene& scene, const geometry::GearPair& pair);

/// Refuses loads and bearings too large for small displacements (small_displacements.h). Throws InputError.
void check_two_k_v_displacements(const Scene& scene);

}  // namespace annulus::app
