#pragma once

#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "dynamics/systems/planetary/spatial_stage.h"

/// A planetary stage of a scene in three dimensions.
namespace annulus::app {

/// Stretches of a face, between whose ends the load is found.
inline constexpr int face_stretches = 24;

/// On the stiffness of its meshes, of which each is multiplied by a factor (1, but for the propagation of their
/// errors). `stretches`: of the faces.
struct FaceChoice {
  double sun_factor = 1, ring_factor = 1;
  int stretches = face_stretches;
};
[[nodiscard]] dynamics::SpatialStage make_spatial_stage(const Scene& scene, const GearGeometry& geometry,
                                                        std::size_t ring, const MeshResult& sun_mesh,
                                                        const MeshResult& ring_mesh, const FaceChoice& choice = {});

/// Whether the stiffness of a mesh changes within a mesh cycle.
[[nodiscard]] bool varies_in_cycle(const MeshInput& mesh);

/// What the stage leaves out, and what is assumed because the scene does not say.
[[nodiscard]] std::vector<Warning> space_warnings(const Scene& scene, std::size_t ring,
                                                  const dynamics::SpatialStage& stage);

}  // namespace annulus::app
