#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// How far the flanks of a mesh are from leaving their held contact state, m, and the rate, m/s. Not negative while the
/// state holds.
struct ContactMargin {
  double value = std::numeric_limits<double>::infinity();  ///< infinite: this end of the backlash is out of reach
  double rate = 0;
};
/// At the end of the backlash where the driving flanks touch, and where the back flanks touch.
struct ContactMargins {
  ContactMargin drive, back;
};
/// From the last evaluation of the meshes. `slack` (m): added to the margins, so that a state that has just begun has
/// one.
[[nodiscard]] ContactMargins contact_margins(const LumpedSystem& system, int mesh, double slack,
                                             const LumpedSystem::Workspace& workspace);

/// The first place in [0, 1] at which the cubic with these values and derivatives at its ends falls below zero.
[[nodiscard]] std::optional<double> first_descent(double begin, double begin_slope, double end, double end_slope);

}  // namespace annulus::dynamics
