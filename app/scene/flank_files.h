#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

/// Reads the measured flanks (left_topography, right_topography) of all gears of a scene. What is wrong with a file
/// becomes a problem of its key.
void read_flank_files(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
