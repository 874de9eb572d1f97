#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

struct PairGeometry;

/// What the scene of a helical pair has besides the common tables.
[[nodiscard]] std::vector<Table> pair_tables();

/// Completes the scene of a helical pair (inertias, centre distance) and checks values that have to agree.
void check_pair_scene(Scene& scene, std::vector<Problem>& problems);

/// Refuses bores without a rim where the mesh is computed, and loads, bearings and errors too large for small
/// displacements. Throws what model_limits.h throws.
void check_pair_geometry(const Scene& scene, const PairGeometry& geometry);

}  // namespace annulus::app
