#pragma once

#include "fem/problem/loaded_mesh_problem.h"

namespace annulus::fem {

/// Estimated relative error of a stiffness in plane strain for a face of finite width: towards its ends the material is
/// free to expand. Solid elements are softer by 5.2, 3.8, 2.8 and 1.2 % (ring mesh) and 4.2, 2.9, 2.4 and 0.6 % (sun
/// mesh) at face widths of 2, 5, 10 and 25 modules and a Poisson ratio of 0.3; plane stress throughout would be softer
/// by nu^2 / (1 - nu^2) = 9.9 %. 0.65 of that, falling with the width in units of ten modules, lies above.
[[nodiscard]] double plane_strain_error(const LoadedMeshProblem& problem);

}  // namespace annulus::fem
