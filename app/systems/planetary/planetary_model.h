#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model/lumped_model.h"
#include "app/model/mesh_result.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"

namespace annulus::app {

/// Why a mesh needs a solid model: what changes along its face width. Empty when nothing does.
[[nodiscard]] std::string solid_reason(const Scene& scene, const RingInput& ring);  ///< ring-planet mesh
[[nodiscard]] std::string solid_reason(const Scene& scene);                         ///< sun-planet mesh

[[nodiscard]] MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry);
[[nodiscard]] MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring);
/// The elastic problem of a ring mesh, for which no model is chosen yet; nothing for a prescribed stiffness.
[[nodiscard]] std::optional<fem::LoadedMeshProblem> ring_mesh_problem(const Scene& scene, const GearGeometry& geometry,
                                                                      std::size_t ring);
/// Sun mesh first, then one per ring.
[[nodiscard]] std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry);

/// The stage with one of its rings. The meshes are referred to.
[[nodiscard]] std::unique_ptr<LumpedModel> planetary_model(const Scene& scene, const GearGeometry& geometry,
                                                           std::size_t ring, const MeshResult& sun_mesh,
                                                           const MeshResult& ring_mesh);
/// The ways of the cost study to this model. All arguments are referred to.
[[nodiscard]] ModelWays planetary_ways(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                       const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// Losses and efficiency (friction_losses.h); nothing without [friction].
[[nodiscard]] FigureSet stage_losses(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                     const MeshResult& sun_mesh, const MeshResult& ring_mesh);
/// The results of studies.
[[nodiscard]] const std::vector<FigureSpec>& stage_study_figures();

}  // namespace annulus::app
