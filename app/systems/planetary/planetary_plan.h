#pragma once

#include <vector>

#include "app/plan/gear_geometry.h"
#include "app/plan/plan.h"

namespace annulus::app {

/// What a plan says of a planetary stage.
void describe_planetary(const Scene& scene, const GearGeometry& geometry, Plan& plan);

// planetary_responses.cc
/// The responses of a planetary scene, one per ring; empty without [dynamics].
[[nodiscard]] std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                               const std::vector<MeshModel>& meshes);
/// Wall time of a study's response of all rings on one core, s, rough.
[[nodiscard]] double planetary_response_seconds(const Scene& scene, const GearGeometry& geometry);

}  // namespace annulus::app
