#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// What the scene of a helical pair has besides the common tables.
[[nodiscard]] std::vector<Table> pair_tables();

/// Completes the scene of a helical pair (inertias, centre distance) and checks values that have to agree.
void check_pair_scene(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
