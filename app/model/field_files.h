#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "app/plan/mesh_model.h"
#include "fem/loaded_mesh.h"

namespace annulus::app {

/// `<stem>_<body>.vtu` of pinion and wheel, and their assembly `<stem>.vtm`.
[[nodiscard]] std::array<std::string, 3> field_file_names(const MeshModel& model, const std::string& stem);

/// Displacement and stress of both bodies at one position, in the frame of their pair (fem::in_frame_of_pair), with
/// load, phase and a proposed exaggeration, for ParaView. `first`: the pinion's in `solved.fields`, which the wheel's
/// follows. Throws FileError on a failed write.
void write_field_files(const MeshModel& model, const fem::LoadedMeshResult& solved, std::size_t first,
                       const std::filesystem::path& folder, const std::string& stem);

}  // namespace annulus::app
