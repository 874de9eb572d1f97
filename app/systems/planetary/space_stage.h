#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/shared/faces.h"
#include "dynamics/systems/planetary/spatial_stage.h"
#include "fem/solid_face.h"

/// A planetary stage of a scene in three dimensions.
namespace annulus::app {

/// How the meshes of a stage are known along their faces.
struct StageFaces {
  /// Solid gears; null: the table of the mesh, spread evenly.
  std::shared_ptr<const fem::SolidFace> sun{}, ring{};
  int stretches = face_stretches;
};
[[nodiscard]] dynamics::SpatialStage make_spatial_stage(const Scene& scene, const GearGeometry& geometry,
                                                        std::size_t ring, const MeshResult& sun_mesh,
                                                        const MeshResult& ring_mesh, const StageFaces& faces);
/// The same without its meshes, before they are solved.
[[nodiscard]] dynamics::SpatialStage spatial_frame(const Scene& scene, const GearGeometry& geometry, std::size_t ring);

/// Whether the stiffness of a mesh changes within a mesh cycle.
[[nodiscard]] bool varies_in_cycle(const MeshInput& mesh);

/// What the stage leaves out, and what is assumed because the scene does not say.
[[nodiscard]] std::vector<Warning> space_warnings(const Scene& scene, std::size_t ring,
                                                  const dynamics::SpatialStage& stage, const StageFaces& faces);

}  // namespace annulus::app
