#pragma once

#include <vector>

#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_scene.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// Bearings that are rigid because the scene says nothing of them, little clearance at tips, prescribed backlash that
/// the geometry does not leave.
[[nodiscard]] std::vector<Warning> stage_scene_warnings(const Scene& scene, const GearGeometry& geometry);
/// Meshes whose back flanks carry load at times. `ring`: name of the variant.
[[nodiscard]] std::vector<Warning> stage_warnings(const dynamics::DynamicResponse& response, const std::string& ring);

}  // namespace annulus::app
