#pragma once

#include "fem/problem/loaded_mesh_problem.h"

namespace annulus::fem {

/// Estimated relative error of the closed form's stiffness by teeth, foundation and contacts: the least there is.
inline constexpr double least_closed_form_error = 0.025;
/// The same with what the bending of a ring on its own supports adds, the largest of some positions under the middle
/// load: it takes solving the closed form there, some milliseconds. Infinite where it cannot be solved.
[[nodiscard]] double closed_form_error(const LoadedMeshProblem& problem);

}  // namespace annulus::fem
