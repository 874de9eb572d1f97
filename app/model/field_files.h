#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/plan/mesh_model.h"
#include "fem/loaded_mesh.h"

namespace annulus::app {

/// `<stem>_<body>.vtu` of pinion and wheel, and their assembly `<stem>.vtm`.
[[nodiscard]] std::array<std::string, 3> field_file_names(const MeshModel& model, const std::string& stem);

/// Displacement and stress of both bodies, in the frame of their pair (fem::in_frame_of_pair), with load, phase and an
/// exaggeration that all of them share, for ParaView. `stems`: of the positions that `solved.fields` has, the pinion
/// and then the wheel of each. Throws FileError on a failed write.
void write_field_files(const MeshModel& model, const fem::LoadedMeshResult& solved, const std::filesystem::path& folder,
                       const std::vector<std::string>& stems);

}  // namespace annulus::app
