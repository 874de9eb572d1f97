#pragma once

#include <cmath>
#include <limits>

namespace annulus::dynamics {

/// A stiffness that leaves no DOF: the DOF it supports is dropped from the system.
inline constexpr double rigid = std::numeric_limits<double>::infinity();

/// N s/m: this share of the critical damping of a mass on a spring.
[[nodiscard]] inline double critical_share(double ratio, double stiffness, double mass) {
  return 2 * ratio * std::sqrt(stiffness * mass);
}

}  // namespace annulus::dynamics
