#pragma once

#include "dynamics/spatial/bearing_assembly.h"
#include "dynamics/spatial/linear_supports.h"

namespace annulus::dynamics {

/// A bearing for small motions about an equilibrium.
struct Linearised {
  LinearBearing bearing;
  LinearBearing::Vector deflection =
      LinearBearing::Vector::Zero();  ///< of the coordinates that something elastic resists
};

/// Tangents, forces and rigid coordinates of a bearing in a state.
[[nodiscard]] Linearised linearised(const MadeBearing& bearing, const Mechanism::Equilibrium& at);

/// Takes what holds along the axis and against tilting off a bearing.
void flatten(LinearBearing& bearing);
/// Keeps a body in the plane.
[[nodiscard]] LinearBearing plane_guide(const StageBody& body);

}  // namespace annulus::dynamics
