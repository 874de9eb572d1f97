#pragma once

#include <filesystem>
#include <string>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"

namespace annulus::app {

/// Contact: gmsh meshes, elastic bodies, contact of one gear mesh at every position and load.
[[nodiscard]] fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options,
                                                  fem::Recovery recovery);

/// The same packed, with the files of the bodies, all written into `folder`; nothing is cached.
[[nodiscard]] MeshResult solved_stiffness(const MeshModel& model, const std::filesystem::path& folder,
                                          const RunOptions& options);
/// Stiffness table with pictures, shares and invariants, all written into OUT/<folder>: from the cache if unchanged,
/// else solved and cached.
[[nodiscard]] MeshResult computed_stiffness(const MeshModel& model, const std::string& folder,
                                            const RunOptions& options);

}  // namespace annulus::app
