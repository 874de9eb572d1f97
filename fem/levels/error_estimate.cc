#include "fem/levels/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/not_known.h"
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

/// Relative differences between two levels as `difference` (of the index of a position) gives them; zero at phases that
/// the coarser level left out, at loads that it left out the larger one of the loads to either side.
template <class Difference>
std::vector<double> differences(const std::vector<LoadedPosition>& coarser, std::size_t loads,
                                const Difference& difference) {
  const auto solved = [&](std::size_t i) { return coarser[i].entry.stiffness_secant != 0; };
  std::vector<double> result(coarser.size());
  for (std::size_t i = 0; i < coarser.size(); ++i)
    if (solved(i)) result[i] = difference(i);
  for (std::size_t first = 0; first < coarser.size(); first += loads) {
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

/// Along the mesh cycle a difference changes its sign here and there, where it says nothing about the error: the
/// largest of a sixteenth of a cycle to either side counts. `values`: [position][load].
std::vector<double> largest_nearby(const std::vector<double>& values, std::size_t loads, int phases) {
  const auto along = static_cast<std::ptrdiff_t>(values.size() / loads);
  const std::ptrdiff_t reach = (phases + 15) / 16;
  std::vector<double> result = values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = static_cast<std::ptrdiff_t>(i / loads);
    for (std::ptrdiff_t k = at - reach; k <= at + reach; ++k) {
      // The last position is the first of the next cycle; a table that repeats closes on itself.
      const std::ptrdiff_t wrapped = (k + along - 1) % (along - 1);
      result[i] = std::max(result[i], values[static_cast<std::size_t>(wrapped) * loads + i % loads]);
    }
  }
  return result;
}

/// What is left of stresses between two levels, and what the notch adds.
struct LeftOfStress {
  double difference = 0, notch = 0;
  [[nodiscard]] double notch_of(double BodyStress::*value) const {
    const bool in_root = value == &BodyStress::root_tension || value == &BodyStress::root_compression ||
                         value == &BodyStress::root_von_mises;
    return in_root ? notch : 0;
  }
};

using StressOf = std::optional<RecoveredStress> LoadedPosition::*;

double stress_size(const LoadedPosition& position, StressOf body, double BodyStress::*value) {
  return position.*body ? std::abs((*(position.*body)).*value) : 0.0;
}

/// Fills the errors of the stresses of one body at every position and load.
void fill_stress_errors(const LoadedMeshProblem& problem, const std::vector<LoadedPosition>& coarser, StressOf body,
                        const LeftOfStress& left, std::vector<LoadedPosition>& positions) {
  const std::size_t loads = problem.loads.size();
  if (std::none_of(positions.begin(), positions.end(), [&](const auto& p) { return (p.*body).has_value(); })) return;
  for (const auto value : stress_values) {
    std::vector<double> largest(loads);
    for (std::size_t i = 0; i < positions.size(); ++i)
      largest[i % loads] = std::max(largest[i % loads], stress_size(positions[i], body, value));
    const auto between = differences(coarser, loads, [&](std::size_t i) {
      const double difference = stress_size(positions[i], body, value) - stress_size(coarser[i], body, value);
      return largest[i % loads] > 0 ? std::abs(difference) / largest[i % loads] : 0.0;
    });
    const auto nearby = largest_nearby(between, loads, problem.phases);
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (auto& stress = positions[i].*body)
        stress->error.*value = left.difference * nearby[i] * largest[i % loads] +
                               left.notch_of(value) * stress_size(positions[i], body, value) + stress->roughness.*value;
  }
}

/// What is left of the largest stresses of one body at the middle load. Positions differ in where the fillet is cut by
/// cells, so that the largest difference of all positions whose stress is near the largest counts.
BodyStress largest_stress_errors(const LoadedMeshProblem& problem, const std::vector<LoadedPosition>& coarser,
                                 const std::vector<LoadedPosition>& positions, StressOf body,
                                 const LeftOfStress& left) {
  constexpr double near = 0.9;
  const std::size_t loads = problem.loads.size();
  BodyStress result;
  for (const auto value : stress_values) {
    double largest = 0, roughness = 0;
    std::optional<double> difference;
    for (std::size_t i = loads / 2; i < positions.size(); i += loads)
      largest = std::max(largest, stress_size(positions[i], body, value));
    for (std::size_t i = loads / 2; i < positions.size(); i += loads)
      if (const double size = stress_size(positions[i], body, value);
          coarser[i].*body && positions[i].*body && size >= near * largest) {
        difference = std::max(difference.value_or(0), std::abs(size - stress_size(coarser[i], body, value)));
        roughness = std::max(roughness, (*(positions[i].*body)).roughness.*value);
      }
    result.*value = left.difference * difference.value_or(not_known) + left.notch_of(value) * largest + roughness;
  }
  return result;
}

/// The largest difference between two levels of the face load factors at the middle load, where they are near the
/// largest.
double face_load_difference(const std::vector<LoadedPosition>& coarser, const std::vector<LoadedPosition>& positions,
                            std::size_t loads) {
  constexpr double near = 0.9;
  double largest = 0, difference = not_known;
  for (std::size_t i = loads / 2; i < positions.size(); i += loads)
    largest = std::max(largest, positions[i].face_load_factor);
  for (std::size_t i = loads / 2; i < positions.size(); i += loads)
    if (coarser[i].entry.stiffness_secant != 0 && positions[i].face_load_factor >= near * largest)
      difference = std::fmax(difference, std::abs(positions[i].face_load_factor - coarser[i].face_load_factor));
  return difference;
}

}  // namespace

LevelErrors estimate_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, const OwnErrors& own,
                            const std::vector<LoadedPosition>& coarser, std::vector<LoadedPosition>& positions,
                            std::optional<double> before) {
  const std::size_t loads = problem.loads.size();
  LevelErrors result;
  const std::vector<double> difference = differences(coarser, loads, [&](std::size_t i) {
    return std::abs(coarser[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
  });
  for (std::size_t i = loads / 2; i < positions.size(); i += loads)
    result.difference = std::max(result.difference, difference[i]);
  const double left = left_over(settings.degree, result.difference, before);
  // The two levels of linear elements are far from their limit in a fillet: up to 2.7 of their difference was left in
  // plane sections (spur teeth with fillets of 0.38 modules).
  const double most_left = settings.degree == 1 ? 3 : most_left_over(settings.degree);
  for (const auto& [body, largest, notch] :
       {std::tuple{&LoadedPosition::pinion_stress, &LevelErrors::pinion_stress, own.pinion_notch},
        {&LoadedPosition::wheel_stress, &LevelErrors::wheel_stress, own.wheel_notch}}) {
    result.*largest = largest_stress_errors(problem, coarser, positions, body, {most_left, notch});
    fill_stress_errors(problem, coarser, body, {most_left, notch}, positions);
  }
  result.face_load_factor = most_left * face_load_difference(coarser, positions, loads);
  const double model = model_error(problem, settings.fidelity);
  const auto nearby = largest_nearby(difference, loads, problem.phases);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    auto& entry = positions[i].entry;
    ErrorParts& parts = entry.error_parts;
    parts.contact = own.contact;
    parts.condensation = positions[i].reciprocity_relative;
    parts.model = model;
    parts.discretisation = std::max(parts.discretisation, left * nearby[i]);
    entry.error_relative = parts.total();
    if (i % loads == loads / 2) result.worst = std::max(result.worst, entry.error_relative - model);
  }
  return result;
}

}  // namespace annulus::fem
