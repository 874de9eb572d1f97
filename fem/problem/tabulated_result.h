#pragma once

#include <vector>

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// The stiffness table of solved positions, with closure and reciprocity. `positions`: [cycle][phase][load] over all
/// cycles after which the structure repeats, then the closure positions, one per load.
[[nodiscard]] LoadedMeshResult tabulated(const LoadedMeshProblem& problem, std::vector<LoadedPosition> positions);

}  // namespace annulus::fem
