#pragma once

#include <optional>
#include <vector>

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// The error of the finer of two levels is at most about so much of their difference.
[[nodiscard]] double most_left_over(int degree);

/// Relative errors that a level estimates by itself.
struct OwnErrors {
  double contact = 0;                        ///< of the stiffness, by the discretised pressure
  double pinion_notch = 0, wheel_notch = 0;  ///< of the stresses in roots, by the cells in the fillet (NotchFactors)
};

/// Errors estimated from two successive levels, relative to the stiffness; the largest of all positions at the middle
/// load.
struct LevelErrors {
  double worst = 0;       ///< estimated error, without what the model leaves out: what the wanted accuracy is about
  double difference = 0;  ///< between the levels
  BodyStress pinion_stress{}, wheel_stress{};  ///< Pa, of the largest stresses at that load; NaN where not known
  double face_load_factor = 0;                 ///< of the largest one at that load; NaN where not known
};

/// Fills the errors of all positions of a level from those of the level before. `before`: the difference that the
/// coarser level had to the one before it, where there was one.
LevelErrors estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, const OwnErrors& own,
                            const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions,
                            std::optional<double> before = {});

}  // namespace annulus::fem
