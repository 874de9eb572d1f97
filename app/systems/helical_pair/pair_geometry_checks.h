#pragma once

#include "app/scene/scene.h"
#include "app/systems/helical_pair/pair_model.h"

namespace annulus::app {

/// Bores stay below the roots. Throws GeometryError, starting with the key, where the mesh is computed.
void check_rims(const Scene& scene, const PairGeometry& geometry);

/// Refuses loads, bearings and errors too large for small displacements (small_displacements.h). Throws InputError.
void check_displacements(const Scene& scene, const PairGeometry& geometry);

}  // namespace annulus::app
