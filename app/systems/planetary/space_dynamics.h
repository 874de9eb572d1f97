#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/shared/face_loads.h"
#include "dynamics/systems/planetary/planetary_stage.h"

/// The dynamics of a planetary stage with bearings, loads and gravity in space.
namespace annulus::app {

/// Whether the scene has [[bearing]] or [[load]] tables or [gravity], with which its bodies move in space.
[[nodiscard]] bool moves_in_space(const Scene& scene);

/// Before any mesh is solved: throws InputError where something moves freely or is held twice.
void check_stage_bearings(const Scene& scene, const GearGeometry& geometry);

/// Replaces the supports of a stage in the plane by its bearings. Throws InputError where something moves freely.
void put_in_space(dynamics::PlanetaryStage& stage, const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                  const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// The faces of its meshes, sun meshes first: solid gears where the dynamics has them, else spread evenly.
[[nodiscard]] MovingFaces moving_stage_faces(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                             const RunOptions& options);

/// What the dynamics assumes and leaves out of these tables.
[[nodiscard]] std::vector<Warning> space_dynamics_warnings(const Scene& scene, const GearGeometry& geometry);

}  // namespace annulus::app
