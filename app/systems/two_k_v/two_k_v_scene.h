#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// What the scene of a 2K-V reducer has besides the common tables.
[[nodiscard]] std::vector<Table> two_k_v_tables();

/// Checks values that have to agree.
void check_two_k_v_scene(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
