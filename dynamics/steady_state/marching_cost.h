#pragma once

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// s on one core, rough: what integrating so many mesh cycles takes by the method and tolerance of the options, from
/// the steps that stability or accuracy ask for. Slow speeds and stiff supports cost in proportion. Parting teeth,
/// which restart the integrator, are not foreseen: they double it.
[[nodiscard]] double marching_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                                      const IntegratorOptions& options);

/// Mesh cycles that a response of this period (in mesh cycles) takes until it is known, marched: the window that
/// confirms a direct solution, or, where none is possible, the windows until two agree. Rough: nearly undamped motions
/// take more, up to `max_windows`.
[[nodiscard]] double marched_cycles(const LumpedSystem& system, double mesh_frequency, int period,
                                    const SimulationOptions& options);

}  // namespace annulus::dynamics
