#pragma once

#include <functional>

#include "app/model/mesh_result.h"
#include "core/figure.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// The stage on these mesh stiffnesses, all else being the same.
using StageMaker = std::function<dynamics::PlanetaryStage(const MeshResult& sun_mesh, const MeshResult& ring_mesh)>;

/// The stiffnesses of a stage, and how it is made from them.
struct StageTables {
  StageMaker make;
  const MeshResult &sun_mesh, &ring_mesh;
};

/// The results that dynamics::for_each_figure visits, with the parts of their errors. `nominal` was simulated with
/// `options` on `tables`; prescribed stiffness is exact (dynamics/error_propagation). Where back flanks carry on a ring
/// that changes from tooth to tooth, the model's part has what the results change when its supports stand elsewhere
/// under them; where the coupling of the meshes is left out as negligible, it has what the coupling changes.
[[nodiscard]] FigureSet propagated_errors(const dynamics::DynamicResponse& nominal,
                                          const dynamics::SimulationOptions& options, const StageTables& tables);

/// Makes every Figure::error the total of these parts.
void set_errors(const FigureSet& errors, dynamics::DynamicResponse& response);

}  // namespace annulus::app
