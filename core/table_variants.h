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

/// Which of two neighbouring phases takes up what the curve jumps between them. Where a tooth takes up its load between
/// two phases, the curve through them neither knows where nor how suddenly.
enum class JumpSide { stiffer, softer };

/// More phases, with jumps between two of the given ones made at once at that end of their interval which makes the
/// stiffness larger (or smaller) between them; without error estimates. What the changes beside an interval have in
/// common with it is no jump: smooth curves stay as they are.
[[nodiscard]] StiffnessTable with_jumps(const StiffnessTable& table, JumpSide side);
/// The largest of these jumps, relative to the mean stiffness at its load.
[[nodiscard]] double largest_jump(const StiffnessTable& table);

}  // namespace annulus
