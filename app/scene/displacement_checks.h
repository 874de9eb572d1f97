#pragma once

#include "app/pair/pair_model.h"
#include "app/scene/scene.h"
#include "app/stage/gear_geometry.h"

namespace annulus::app {

/// Displacements and strains are taken for small: flanks meet where those without load and errors do. Throws
/// InputError, starting with the key, where a load, a support or an error of the scene is plainly too large for that;
/// what shows only when the bodies are solved is refused there (fem/problem_check.h).
void check_displacements(const Scene& scene, const GearGeometry& geometry);
void check_displacements(const Scene& scene, const PairGeometry& geometry);
/// Of the bearings and of the sun and a planet of a 2K-V stage.
void check_two_k_v_displacements(const Scene& scene);

}  // namespace annulus::app
