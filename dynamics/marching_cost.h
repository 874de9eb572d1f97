#pragma once

#include "dynamics/integrate.h"
#include "dynamics/lumped_system.h"

namespace annulus::dynamics {

/// s on one core, rough: what integrating so many mesh cycles takes by the method and tolerance of the options, from
/// the steps that stability or accuracy ask for. Slow speeds and stiff supports cost in proportion. Parting teeth,
/// which restart the integrator, are not foreseen: they double it.
[[nodiscard]] double marching_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                                      const IntegratorOptions& options);

}  // namespace annulus::dynamics
