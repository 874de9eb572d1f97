#pragma once

#include <optional>
#include <vector>

#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// Estimated relative error of a stiffness in plane strain for a face of finite width: towards its ends the material is
/// free to expand. Solid elements are softer by 5.2, 3.8, 2.8 and 1.2 % (ring mesh) and 4.2, 2.9, 2.4 and 0.6 % (sun
/// mesh) at face widths of 2, 5, 10 and 25 modules and a Poisson ratio of 0.3; plane stress throughout would be softer
/// by nu^2 / (1 - nu^2) = 9.9 %. 0.65 of that, falling with the width in units of ten modules, lies above.
[[nodiscard]] double plane_strain_error(const LoadedMeshProblem& problem);

/// The error of the finer of two levels is at most about so much of their difference.
[[nodiscard]] double most_left_over(int degree);

/// What two successive levels tell; relative to the stiffness, the largest of all positions at the middle load.
struct LevelErrors {
  double worst = 0;       ///< estimated error, without what the rung leaves out: what the wanted accuracy is about
  double difference = 0;  ///< between the levels
};

/// Fills the errors of all positions of a level from those of the level before; `contact` is the relative error of the
/// stiffness by the discretised pressure (SolvedLevel::contact_error). `before`: the difference that the coarser level
/// had to the one before it, where there was one.
LevelErrors estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, double contact,
                            const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions,
                            std::optional<double> before = {});

}  // namespace annulus::fem
