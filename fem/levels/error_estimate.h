#pragma once

#include <optional>
#include <vector>

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// The error of the finer of two levels is at most about so much of their difference.
[[nodiscard]] double most_left_over(int degree);

/// Errors estimated from two successive levels, relative to the stiffness; the largest of all positions at the middle
/// load.
struct LevelErrors {
  double worst = 0;       ///< estimated error, without what the model leaves out: what the wanted accuracy is about
  double difference = 0;  ///< between the levels
};

/// Fills the errors of all positions of a level from those of the level before; `contact` is the relative error of the
/// stiffness by the discretised pressure (SolvedLevel::contact_error). `before`: the difference that the coarser level
/// had to the one before it, where there was one.
LevelErrors estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, double contact,
                            const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions,
                            std::optional<double> before = {});

}  // namespace annulus::fem
