#pragma once

#include <vector>

#include "app/scene/scene_schema.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

/// What the scene of a 2K-V reducer has besides the common tables.
[[nodiscard]] std::vector<Table> two_k_v_tables();

/// Checks values that have to agree.
void check_two_k_v_scene(Scene& scene, std::vector<Problem>& problems);

/// Refuses bores of sun and planet without a rim where their mesh is computed, and loads and bearings too large for
/// small displacements. Throws what model_limits.h throws.
void check_two_k_v_geometry(const Scene& scene, const geometry::GearPair& pair);

}  // namespace annulus::app
