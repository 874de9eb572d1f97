#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/plan/plan.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/helical_pair/pair_model.h"
#include "app/systems/shared/face_loads.h"
#include "core/face_shape.h"

/// Pairs whose gears lie in bearings with places, and tilt.
namespace annulus::app {

/// Whether the scene has [[bearing]] or [[load]] tables or [gravity].
[[nodiscard]] bool pair_in_space(const Scene& scene);

/// Before the mesh is solved: throws InputError where something moves freely or is held twice.
void check_pair_bearings(const Scene& scene, const PairGeometry& geometry);

/// Why gears tilt; empty: they do not.
[[nodiscard]] std::string why_gears_tilt(const Scene& scene, const PairGeometry& geometry);

/// Replaces the bearings of a pair in its plane by those of the scene. `face`: of solid gears, or null. Throws
/// InputError where something moves freely.
void put_in_space(dynamics::HelicalPair& pair, const Scene& scene, const PairGeometry& geometry,
                  const std::shared_ptr<const FaceShape>& face);

/// The face of its mesh: solid gears where the dynamics has them, else spread evenly.
[[nodiscard]] MovingFaces moving_pair_face(const Scene& scene, const PairGeometry& geometry,
                                           const dynamics::HelicalPair& pair, const MeshResult& mesh,
                                           const RunOptions& options);

/// Degrees of freedom and why they are there or not. `plane`: those of the plane.
[[nodiscard]] std::vector<DofPlan> pair_dofs_in_space(const Scene& scene, const PairGeometry& geometry,
                                                      std::vector<DofPlan> plane);
/// What the dynamics assumes and leaves out of these tables.
[[nodiscard]] std::vector<Warning> pair_space_warnings(const Scene& scene);

}  // namespace annulus::app
