#pragma once

#include <vector>

#include "app/plan/mesh_model.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// How the motion of a planetary stage is found in time, and why so. The scene has [dynamics].
[[nodiscard]] std::vector<Decision> motion_decisions(const Scene& scene, const std::vector<MeshModel>& meshes);

}  // namespace annulus::app
