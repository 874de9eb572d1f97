#pragma once

#include "geometry/sector_mesh.h"

namespace annulus::geometry {

/// The tooth sector as gmsh fills its blocks, with vertices in the order of gmsh's node numbers; what follows is done
/// by make_sector_mesh. Throws InternalError when gmsh refuses.
[[nodiscard]] Mesh meshed_sector(const Gear& gear, const Rim& rim, const SectorResolution& resolution);

}  // namespace annulus::geometry
