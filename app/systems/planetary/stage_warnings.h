#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// Sentences without which the results of a response are not to be trusted: bearings that are rigid because the scene
/// says nothing of them, and meshes whose back flanks carry load at times.
[[nodiscard]] std::vector<std::string> stage_warnings(const Scene& scene, const dynamics::DynamicResponse& response);

}  // namespace annulus::app
