#pragma once

#include <vector>

#include "dynamics/system/drive_line.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The system with what its friction takes from the driven bodies: with the given torques alone it would brake the
/// rotation of the whole. The torques of the bodies that take power become smaller by what the mean forces of the
/// meshes lose in friction (LoadCause::losses); where several rotations are free, those of all bodies but the strongest
/// that drives. Of what then still acts on a free rotation, which nothing elastic feels, friction is kept away.
///
/// A system without friction, or without a free rotation, remains as it is; without torques nothing is taken. Throws
/// InputError where no torque of `ends` can balance the friction.
[[nodiscard]] LumpedSystem with_balanced_friction(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                                  const std::vector<ShaftEnd>& ends);

}  // namespace annulus::dynamics
