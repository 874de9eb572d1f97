#pragma once

#include <filesystem>

#include "geometry/mesh.h"
#include "geometry/sector_mesh.h"

namespace annulus::geometry {

/// What annulus lets gmsh do, in a library of its own that is loaded when it is needed.
struct Meshing {
  /// The sector as gmsh makes it; see make_sector_mesh, which checks the rim before and the cells after.
  Mesh (*sector)(const Gear& gear, const Rim& rim, const SectorResolution& resolution);
  void (*write_msh)(const Mesh& mesh, const std::filesystem::path& file);
};

/// Throws FileError when the library cannot be loaded.
[[nodiscard]] const Meshing& meshing();

}  // namespace annulus::geometry
