#pragma once

#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

struct SteadyProblem;

/// The meshes that can lose contact, by their numbers.
[[nodiscard]] std::vector<int> meshes_with_backlash(const LumpedSystem& system);

/// Bound of the vibration over the smallest static deflection of a mesh beyond its backlash, the largest of all meshes
/// with backlash; 0 without backlash, infinite where a mesh carries nothing at some time without any vibration, or
/// where no bound is found. The bound takes every harmonic of the forces that stiffness and errors exert at constant
/// approach, and every load that changes, at the natural frequencies of the system with mean stiffness from a third to
/// three times its own. Mesh vectors that move are taken at time 0. Near and above 1 teeth may lose contact, and
/// several motions may exist.
[[nodiscard]] double reach_of_backlash(const LumpedSystem& system, const SteadyProblem& problem);
/// From this bound on other motions are looked for; spur pairs that have several reach it (test).
inline constexpr double within_reach = 0.5;

}  // namespace annulus::dynamics
