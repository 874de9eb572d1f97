#pragma once

#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// Throws InputError when a problem makes no sense whatever the rung, or is one of the face width on a rung that has
/// none (plane, closed form).
void check_problem(const LoadedMeshProblem& problem, Rung rung);

}  // namespace annulus::fem
