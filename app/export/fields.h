#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Deformed bodies of all meshes of a scene with finite elements over a mesh cycle, each mesh alone under its nominal
/// load: `file` (.pvd), whose time is the mesh phase, and what it names in a folder of the same name. All meshes share
/// one frame: the axis of the wheel, the pinion at its centre distance on +x. `variant`: of a scene with several; its
/// meshes and those that all share. Superelements come from the cache; the contact is solved anew. Returns `file`.
/// Throws InputError for another ending and for a scene without such a mesh or variant, and what solving throws.
[[nodiscard]] std::vector<std::filesystem::path> write_mesh_cycle(const Scene& scene, const std::string& variant,
                                                                  int threads, const std::filesystem::path& file);

}  // namespace annulus::app
