#pragma once

#include <string>

#include "core/stiffness_table.h"
#include "fem/problem/loaded_mesh_problem.h"

/// Stiffness of helical gear meshes in closed form. Tables hold forces and transmission errors along the transverse
/// line of action, as all tables of annulus do.
namespace annulus::fem {

/// Why a helical mesh has no closed form; empty when it has one.
[[nodiscard]] std::string no_helical_closed_form(const geometry::GearParameters& pinion,
                                                 const geometry::GearParameters& wheel, double misalignment);

/// The closed form of the transverse section, its slices staggered along the helix: at one phase they stand at phases
/// spread over the overlap ratio and share one deflection along the transverse line of action. Loads of the problem are
/// transverse (N). The error of a closed form is not controlled. Throws InputError where there is none.
[[nodiscard]] StiffnessTable helical_closed_form(const LoadedMeshProblem& problem);

/// The table with forces and transmission errors along the normal of the flanks instead of the transverse line of
/// action.
[[nodiscard]] StiffnessTable along_normal(const StiffnessTable& transverse, double base_helix_angle);

}  // namespace annulus::fem
