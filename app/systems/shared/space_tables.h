#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

/// Bearings in their places, loads that are no torques, gravity: tables of systems whose bodies tilt.
namespace annulus::app {

enum class SpaceOf { planetary, pair };

/// [[bearing]], [[load]], [gravity], [tilt_inertia]
[[nodiscard]] std::vector<Table> space_tables(SpaceOf of);
/// Names, lengths of lists, and bodies that fit each other.
void check_space(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
