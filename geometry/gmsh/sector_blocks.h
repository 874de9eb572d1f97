#pragma once

#include <utility>
#include <vector>

#include "geometry/sector_mesh.h"

namespace annulus::geometry {

/// What gmsh has been given: curves with their boundary, blocks with their region, by gmsh tag.
struct SectorBlocks {
  std::vector<std::pair<int, Boundary>> curves;
  std::vector<std::pair<int, Mesh::Region>> blocks;
};

/// Describes the blocks of a tooth sector to the current gmsh model, in lengths of one module, with all mesh
/// constraints.
[[nodiscard]] SectorBlocks describe_sector(const Gear& gear, const Rim& rim, const SectorResolution& resolution);

}  // namespace annulus::geometry
