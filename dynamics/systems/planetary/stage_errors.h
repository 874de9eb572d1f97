#pragma once

#include <vector>

#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// Terms of e_sn and e_rn from eccentricities and position errors (signs: see sun_mesh_error).
[[nodiscard]] std::vector<HarmonicError> sun_mesh_errors(const PlanetaryStage& stage, int n);
[[nodiscard]] std::vector<HarmonicError> ring_mesh_errors(const PlanetaryStage& stage, int n);

}  // namespace annulus::dynamics
