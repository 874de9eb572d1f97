#pragma once

#include <vector>

#include "app/model/mesh_result.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

/// Stages that differ from one in what its model leaves open, each in one thing. What a result changes by from the
/// stage to one of them is a part of its error: couplings that were left out as negligible, what the two meshes of a
/// planet disagree about, tilting faces that are not straight.
[[nodiscard]] std::vector<dynamics::PlanetaryStage> alternative_stages(const dynamics::PlanetaryStage& stage,
                                                                       const MeshResult& sun_mesh,
                                                                       const MeshResult& ring_mesh);

}  // namespace annulus::app
