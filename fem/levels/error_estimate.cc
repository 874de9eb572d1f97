#include "fem/levels/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/body/resolution.h"

namespace annulus::fem {

double most_left_over(int degree) {
  // Linear elements approach their limit with the first power of the cell size: what is left of them at a ratio of 1.5
  // is twice the difference. Near singular edges of a support the error of others falls little faster than that, and
  // the difference is about the error itself; where the contact dominates it falls at least with the square.
  return degree == 1 ? 1 / (level_ratio - 1) : 1;
}

namespace {

/// The error of the finer of two levels over their difference.
double left_over(int degree, double difference, std::optional<double> before) {
  const double most = most_left_over(degree);
  // With two differences the next ones are taken to shrink as these did, and no faster than with the cube.
  if (degree == 1 || !before) return most;
  const double least = 1 / (std::pow(level_ratio, 3) - 1);
  const double ratio = difference / *before;
  return ratio < 0.5 ? std::max(least, ratio / (1 - ratio)) : most;
}

/// Relative, of the stiffness; zero at phases that the coarser level left out, at loads that it left out the larger one
/// of the loads to either side.
std::vector<double> differences(const std::vector<LoadedPosition>& coarser,
                                const std::vector<LoadedPosition>& positions, std::size_t loads) {
  const auto solved = [&](std::size_t i) { return coarser[i].entry.stiffness_secant != 0; };
  std::vector<double> result(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (solved(i)) result[i] = std::abs(coarser[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
  for (std::size_t first = 0; first < positions.size(); first += loads) {
    if (!solved(first)) continue;
    for (std::size_t low = 0, high = 1; high < loads; ++high) {
      if (!solved(first + high)) continue;
      for (std::size_t load = low + 1; load < high; ++load)
        result[first + load] = std::max(result[first + low], result[first + high]);
      low = high;
    }
  }
  return result;
}

/// What is left of the largest stresses of one body. Positions differ in where the fillet is cut by cells, so that the
/// largest difference of all positions whose stress is near the largest counts.
BodyStress stress_errors(const std::vector<LoadedPosition>& coarser, const std::vector<LoadedPosition>& positions,
                         std::optional<BodyStress> LoadedPosition::*body, double left, double notch) {
  constexpr double near = 0.9;
  BodyStress result;
  for (const auto value : stress_values) {
    const auto size = [&](const LoadedPosition& p) { return p.*body ? std::abs((*(p.*body)).*value) : 0.0; };
    double largest = 0, difference = std::numeric_limits<double>::quiet_NaN();
    for (const auto& p : positions) largest = std::max(largest, size(p));
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (coarser[i].*body && positions[i].*body && size(positions[i]) >= near * largest)
        difference = std::fmax(difference, std::abs(size(positions[i]) - size(coarser[i])));
    const bool in_root = value == &BodyStress::root_tension || value == &BodyStress::root_compression ||
                         value == &BodyStress::root_von_mises;
    result.*value = left * difference + (in_root ? notch * largest : 0);
  }
  return result;
}

}  // namespace

LevelErrors estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, const OwnErrors& own,
                            const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions,
                            std::optional<double> before) {
  const std::size_t loads = problem.loads.size();
  LevelErrors result;
  std::vector<double> difference = differences(coarser, positions, loads);
  for (std::size_t i = loads / 2; i < positions.size(); i += loads)
    result.difference = std::max(result.difference, difference[i]);
  const double left = left_over(settings.degree, result.difference, before);
  // The two levels of linear elements are far from their limit in a fillet: up to 2.7 of their difference was left in
  // plane sections (spur teeth with fillets of 0.38 modules).
  const double most_left = settings.degree == 1 ? 3 : most_left_over(settings.degree);
  result.planet_stress = stress_errors(coarser, positions, &LoadedPosition::planet_stress, most_left, own.planet_notch);
  result.wheel_stress = stress_errors(coarser, positions, &LoadedPosition::wheel_stress, most_left, own.wheel_notch);
  for (double& d : difference) d *= left;
  const bool plane = settings.fidelity == Fidelity::plane || settings.fidelity == Fidelity::resolved_plane;
  const double model = plane ? plane_strain_error(problem) : 0;
  // Along the mesh cycle the difference changes its sign here and there, where it says nothing about the error: the
  // largest of a sixteenth of a cycle to either side counts.
  const auto along = static_cast<std::ptrdiff_t>(positions.size() / loads);
  const std::ptrdiff_t reach = (problem.phases + 15) / 16;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    auto& entry = positions[i].entry;
    ErrorParts& parts = entry.error_parts;
    parts.contact = own.contact;
    parts.condensation = positions[i].reciprocity_relative;
    parts.model = model;
    const auto at = static_cast<std::ptrdiff_t>(i / loads);
    for (std::ptrdiff_t k = at - reach; k <= at + reach; ++k) {
      // The last position is the first of the next cycle; a table that repeats closes on itself.
      const std::ptrdiff_t wrapped = (k + along - 1) % (along - 1);
      parts.discretisation = std::max(parts.discretisation, difference[wrapped * loads + i % loads]);
    }
    entry.error_relative = parts.total();
    if (i % loads == loads / 2) result.worst = std::max(result.worst, entry.error_relative - model);
  }
  return result;
}

}  // namespace annulus::fem
