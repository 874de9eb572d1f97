#pragma once

#include "core/stiffness_table.h"

namespace annulus {

/// Tables changed within their own uncertainty, to carry it into what is computed from them.

/// Every stiffness raised by its error estimate: what the estimate does to the mean.
[[nodiscard]] StiffnessTable stiffer(const StiffnessTable& table);
/// Stiffnesses above the mean at their load raised by their error estimate, the others lowered: what it can do to the
/// ripple.
[[nodiscard]] StiffnessTable more_rippled(const StiffnessTable& table);
/// Every second phase only: what the interpolation between the phases does. Throws InputError for an odd number.
[[nodiscard]] StiffnessTable coarser(const StiffnessTable& table);
/// The same with the other half of the phases: the curve through them gives the values at the phases between. A largest
/// value that is at a phase `coarser` keeps shows only here. Throws InputError for an odd number.
[[nodiscard]] StiffnessTable through_odd_phases(const StiffnessTable& table);

/// Where between two phases a tooth pair takes up or gives up its load, which the curve through them does not know.
enum class JumpSide { stiffer, softer };

/// More phases, with jumps between two of the given ones made at that end of their interval which makes the stiffness
/// larger (or smaller) between them; without error estimates. What the changes beside an interval have in common with
/// it is no jump: smooth curves stay as they are. A jump takes the share `uptake` x root of the load in N of a mesh
/// cycle; where that is more than the distance between two phases, these have resolved it.
[[nodiscard]] StiffnessTable with_jumps(const StiffnessTable& table, JumpSide side, double uptake);
/// The largest of these jumps, relative to the mean stiffness at its load.
[[nodiscard]] double largest_jump(const StiffnessTable& table, double uptake);

}  // namespace annulus
