#pragma once

#include <functional>
#include <vector>

#include "app/model/mesh_result.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// Absolute errors of the figures of one kind of mesh, NaN where not known.
struct MeshKindErrors {
  ErrorParts instantaneous, averaged, quasi_static;     ///< load sharing
  std::vector<ErrorParts> peak_factor, dynamic_factor;  ///< one per planet
};

struct ResponseErrors {
  MeshKindErrors sun_planet, ring_planet;
  std::vector<ErrorParts> shafts;  ///< of their largest torques, N m
};

/// The stage on these mesh stiffnesses, all else being the same.
using StageMaker = std::function<dynamics::PlanetaryStage(const MeshResult& sun_mesh, const MeshResult& ring_mesh)>;

/// The stiffnesses of a stage, and how it is made from them.
struct StageTables {
  StageMaker make;
  const MeshResult &sun_mesh, &ring_mesh;
};

/// The parts of the error of every figure of `nominal`, which was simulated with `options` on `tables`, by
/// dynamics/error_propagation. Prescribed stiffness is exact. Where back flanks carry on a ring that changes from tooth
/// to tooth, the model's part has what the results change when its supports stand elsewhere under them; where the
/// coupling of the meshes is left out as negligible, it has what the coupling changes.
[[nodiscard]] ResponseErrors propagated_errors(const dynamics::DynamicResponse& nominal,
                                               const dynamics::SimulationOptions& options, const StageTables& tables);

/// Makes Figure::error the total of the parts.
void set_errors(const ResponseErrors& errors, dynamics::DynamicResponse& response);

}  // namespace annulus::app
