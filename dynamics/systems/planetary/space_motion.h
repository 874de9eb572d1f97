#pragma once

#include "dynamics/spatial/space_motion.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// Empty for a plane stage. `series` must belong to the stage.
[[nodiscard]] SpaceMotion space_motion(const PlanetaryStage& stage, const TimeSeries& series);
/// `lumped`: assemble(stage).
[[nodiscard]] SpaceMotion space_motion(const PlanetaryStage& stage, const LumpedSystem& lumped,
                                       const TimeSeries& series);

}  // namespace annulus::dynamics
