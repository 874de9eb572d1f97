#pragma once

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// Rough time on one core (s) for the integration of `cycles` mesh cycles with the method and tolerance of the options.
/// It follows from the steps that stability or accuracy need, so slow speeds and stiff supports cost in proportion.
/// Loss of contact, which restarts the integrator, is not predicted and doubles it. `mesh_frequency` in Hz.
[[nodiscard]] double integration_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                                         const IntegratorOptions& options);

/// Rough number of mesh cycles that are integrated in time for a response of this period (mesh cycles). It is the
/// window that confirms a periodic solution or, where none is possible, the windows until two agree. Nearly undamped
/// motions take more, up to `max_windows`.
[[nodiscard]] double integrated_cycles(const LumpedSystem& system, double mesh_frequency, int period,
                                       const SimulationOptions& options);

}  // namespace annulus::dynamics
