#pragma once

#include "dynamics/steady_state/response_window.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Largest modulus of the Floquet multipliers of one mesh cycle about a periodic motion without loss of contact. Above
/// 1 small disturbances grow (parametric resonance), below 1 they die out.
///
/// The tangents at the samples of the first cycle of the window are taken as constant around each sample. Undamped
/// motions stay at 1 to rounding; limits of resonances are accurate to the second order of the spacing. Throws
/// SolverError when the eigenvalue solver fails.
[[nodiscard]] double growth_per_cycle(const LumpedSystem& system, double mesh_frequency, const ResponseWindow& window);

}  // namespace annulus::dynamics
