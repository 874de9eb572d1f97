#pragma once

#include "dynamics/steady_state/response_window.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Largest magnitude of the Floquet multipliers of one mesh cycle about a periodic motion in which no mesh separates:
/// how small disturbances grow (above 1: parametric resonance) or die per cycle. From the tangents at the samples of
/// the window's first cycle, each taken as constant around its sample: undamped motions stay at 1 to rounding, and the
/// edges of resonances are found to the second order of the spacing.
[[nodiscard]] double growth_per_cycle(const LumpedSystem& system, double mesh_frequency, const ResponseWindow& window);

}  // namespace annulus::dynamics
