#pragma once

#include <optional>
#include <string>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"

namespace annulus::app {

/// Contact: gmsh meshes, elastic bodies, contact of one gear mesh at every position and load.
[[nodiscard]] fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options);

/// Stiffness table with pictures, shares and invariants in OUT/<folder>: from the cache if unchanged, else solved,
/// packed and cached.
[[nodiscard]] MeshResult computed_stiffness(const MeshModel& model, const std::string& folder,
                                            const RunOptions& options);
/// Only from the cache; nothing when it is not there.
[[nodiscard]] std::optional<MeshResult> cached_stiffness(const MeshModel& model, const std::string& folder,
                                                         const RunOptions& options);

}  // namespace annulus::app
