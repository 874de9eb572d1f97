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

}  // namespace annulus
