#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

/// Bearings in their places, loads that are no torques, and gravity: tables of planetary stages.
namespace annulus::app {

/// [[bearing]], [[load]], [gravity], [tilt_inertia], [statics]
[[nodiscard]] std::vector<Table> space_tables();
/// Names, lengths of lists, and bodies that fit each other.
void check_space(Scene& scene, std::vector<Problem>& problems);
/// In the mirror image y, and what turns about x and z, have the other sign.
void mirror_space(Scene& scene);

}  // namespace annulus::app
