#pragma once

#include <filesystem>

#include "geometry/mesh.h"

namespace annulus::geometry {

/// See write_msh.
void write_msh_file(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace annulus::geometry
