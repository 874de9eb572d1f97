#pragma once

#include <vector>

#include "app/model/stiff_supports.h"
#include "app/plan/plan.h"
#include "app/systems/planetary/stage_geometry.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

/// What a plan reports of a planetary stage.
void describe_planetary(const Scene& scene, const GearGeometry& geometry, Plan& plan);

/// How the motion is found in time, and why so (motion_plan.cc). The scene has [dynamics].
[[nodiscard]] std::vector<Decision> motion_decisions(const Scene& scene, const std::vector<MeshModel>& meshes);

/// The stage of one ring before its stiffnesses are computed (planetary_responses.cc). The scene has [dynamics].
[[nodiscard]] dynamics::PlanetaryStage rough_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                                   RoughCourse course = RoughCourse::constant);
/// The responses of a planetary scene, one per ring (planetary_responses.cc); empty without [dynamics].
[[nodiscard]] std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                               const std::vector<MeshModel>& meshes);

}  // namespace annulus::app
