#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

/// Bearings, loads and structures of planetary stages in space.
namespace annulus::app {

/// Those of space_tables(), [carrier_structure], [housing], [statics].
[[nodiscard]] std::vector<Table> structure_tables();
/// check_space(), and files and sizes of the structures.
void check_structure(Scene& scene, std::vector<Problem>& problems);
/// In the mirror image y, and what turns about x and z, have the other sign.
void mirror_space(Scene& scene);

}  // namespace annulus::app
