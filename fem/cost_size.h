#pragma once

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

/// How large the solve of a loaded mesh will be, counted without meshing or solving anything.
namespace annulus::fem {

/// Finest level of resolution a model has; 0 for the closed form.
[[nodiscard]] int last_level(Fidelity fidelity);
/// Finest level of linear elements, after which quadratic ones follow. In the plane refined linear elements cost as
/// much as quadratic ones of the first level, which are better by far; of helical teeth quadratic solids cost ten times
/// as much.
[[nodiscard]] int last_linear_level(const LoadedMeshProblem& problem);

/// DOFs of the two sectors at a level (LoadedMeshResult::unknowns): exact to a per cent in the plane, an estimate
/// for solid bodies, whose sleeves, hoops and flanges are counted by their share of the section. Of the
/// resolved models the regular teeth, which their patches are about as large as. 0 for the closed form.
[[nodiscard]] double estimated_unknowns(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                        int level);

/// Pins, bolts or spline teeth that take part in every contact problem of formulas and of plane rings; of a solid ring
/// at a level their forces, every slice of the face counted. 0 for other models and structures.
[[nodiscard]] double support_forces(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level);

}  // namespace annulus::fem
