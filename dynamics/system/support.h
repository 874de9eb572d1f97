#pragma once

#include <cmath>
#include <limits>

namespace annulus::dynamics {

/// A rigid support: its DOF is dropped from the system.
inline constexpr double rigid = std::numeric_limits<double>::infinity();

/// Damping, N s/m: the share `ratio` of the critical damping of a mass (kg) on a spring (N/m).
[[nodiscard]] inline double critical_share(double ratio, double stiffness, double mass) {
  return 2 * ratio * std::sqrt(stiffness * mass);
}

}  // namespace annulus::dynamics
