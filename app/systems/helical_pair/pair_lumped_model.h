#pragma once

#include <memory>

#include "app/model/lumped_model.h"
#include "app/systems/helical_pair/pair_stiffness.h"

namespace annulus::app {

/// The pair on this stiffness.
[[nodiscard]] std::unique_ptr<LumpedModel> pair_lumped_model(const Scene& scene, const PairGeometry& geometry,
                                                             const PairMesh& mesh);
/// The ways of the cost study to it.
[[nodiscard]] ModelWays pair_ways(const Scene& scene, const PairGeometry& geometry, const PairMesh& mesh);

}  // namespace annulus::app
