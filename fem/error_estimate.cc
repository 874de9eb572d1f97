#include "fem/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "fem/resolution.h"

namespace annulus::fem {

double plane_strain_error(const LoadedMeshProblem& problem) {
  const double nu = problem.material.poisson_ratio;
  const double width = problem.face_width / problem.pair.planet().parameters().module;
  return 0.65 * nu * nu / (1 - nu * nu) / (1 + width / 10);
}

double estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, double contact,
                       const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions) {
  const std::size_t loads = problem.loads.size();
  // The error falls at least with the square of the cell size where the contact dominates, so that the difference of
  // two levels overestimates that of the finer one; near singular edges of a support it falls more slowly and the
  // difference is about the error itself. Linear elements approach their limit with the first power of the cell size:
  // what is left of them at a ratio of 1.5 is twice the difference.
  const double left = settings.degree == 1 ? 1 / (level_ratio - 1) : 1;
  std::vector<double> difference(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    difference[i] = left * std::abs(coarser[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
  const bool plane = settings.rung == Rung::plane || settings.rung == Rung::resolved_plane;
  const double model = plane ? plane_strain_error(problem) : 0;
  // Along the mesh cycle the difference changes its sign here and there, where it says nothing about the error: the
  // largest of a sixteenth of a cycle to either side counts.
  const auto along = static_cast<std::ptrdiff_t>(positions.size() / loads);
  const std::ptrdiff_t reach = (problem.phases + 15) / 16;
  double worst = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    auto& entry = positions[i].entry;
    ErrorParts& parts = entry.error_parts;
    parts.contact = contact;
    parts.condensation = positions[i].reciprocity_relative;
    parts.model = model;
    const auto at = static_cast<std::ptrdiff_t>(i / loads);
    for (std::ptrdiff_t k = at - reach; k <= at + reach; ++k) {
      // The last position is the first of the next cycle; a table that repeats closes on itself.
      const std::ptrdiff_t wrapped = (k + along - 1) % (along - 1);
      parts.discretisation = std::max(parts.discretisation, difference[wrapped * loads + i % loads]);
    }
    entry.error_relative = parts.total();
    if (i % loads == loads / 2) worst = std::max(worst, entry.error_relative - model);
  }
  return worst;
}

}  // namespace annulus::fem
