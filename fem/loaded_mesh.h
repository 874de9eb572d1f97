#pragma once

#include "fem/closed_form/closed_form_error.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"
#include "fem/problem/structures/clamped.h"
#include "fem/problem/structures/pin_held.h"
#include "fem/problem/structures/spline_held.h"
#include "fem/problem/structures/surface_held.h"

namespace annulus::fem {

/// Solves every position. Throws SolverError naming position, load and residual when one does not converge, and when
/// the finest level does not reach the accuracy.
[[nodiscard]] LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings);

}  // namespace annulus::fem
