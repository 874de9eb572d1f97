#pragma once

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// Throws InputError when a problem makes no sense whatever the model, or is one of the face width on a model that has
/// none (plane, closed form).
void check_problem(const LoadedMeshProblem& problem, Fidelity fidelity);

/// Throws InputError when the flanks come nearer to each other than the settings permit.
void check_deflection(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                      const LoadedPosition& position);
/// Throws InternalError where the transmission error of a solved position does not rise with the load. The solution of
/// a convex problem rises; its pressure elements, whose windows change with the load, may take from that 0.2 % of the
/// deflection: the largest stated error of the local contact of the shipped scenes.
void check_rise(const LoadedMeshProblem& problem, const std::vector<LoadedPosition>& positions);

/// m: turn of a rigid ring on its pins or splines under a mesh force (N), as displacement along the line of action; the
/// ring's own deflection and its shift come on top. Play counts where it lets the ring turn. Infinite where nothing
/// holds it.
[[nodiscard]] double turn_on_supports(const LoadedMeshProblem& problem, double force);

}  // namespace annulus::fem
