#pragma once

#include "fem/closed_form/closed_form_body.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// A loaded mesh without finite elements: energy method for the teeth, plane ring theory for what carries them, line
/// contact that depends on the load, one unknown force per tooth pair. Same table, positions, load shares and pin
/// states as solve_loaded_mesh(); no meshes, no stresses, level 0.
///
/// Plane strain over the full face width. Refused with InputError: structures that bend along the width (held at an end
/// face or a flange), lead modifications and misalignment. `settings.accuracy` is not looked at: the error cannot be
/// reduced, it is estimated from the differences to the plane finite elements (docs/methods.md).
[[nodiscard]] LoadedMeshResult solve_closed_form(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings);
[[nodiscard]] LoadedMeshResult solve_closed_form(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                                 const RimModel& rim);

}  // namespace annulus::fem
