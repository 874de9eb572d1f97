#include "fem/loaded_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/closed_form/closed_form_mesh.h"
#include "fem/level.h"
#include "fem/problem_check.h"
#include "fem/resolution.h"

namespace annulus::fem {
namespace {

/// Teeth after which the structure of the wheel repeats.
int repeating_teeth(const LoadedMeshProblem& problem) {
  return repeating_teeth(problem.structure, problem.pair.wheel().teeth());
}

/// The ring mesh is solved in a mirror image of the real one, which turns the hands of helical gears.
geometry::GearPair solved_pair(const geometry::GearPair& pair) {
  if (!pair.internal() || pair.planet().helix_angle() == 0) return pair;
  const auto mirrored = [](const geometry::Gear& gear) {
    auto parameters = gear.parameters();
    parameters.helix_angle = -parameters.helix_angle;
    return geometry::Gear(parameters);
  };
  return {mirrored(pair.planet()), mirrored(pair.wheel()), pair.centre_distance()};
}

/// Fills the error of every entry from the positions of the level before; returns the largest at the middle load.
///
/// The error falls at least with the square of the cell size where the contact dominates, so that the difference of two
/// levels overestimates that of the finer one; near singular edges of a support it falls more slowly and the difference
/// is about the error itself.
///
/// Linear elements approach their limit with the first power of the cell size: what is left of them at a ratio of 1.5
/// is twice the difference.
double estimate_errors(const LoadedMeshProblem& problem, int degree, const std::vector<LoadedPosition>& coarser,
                       std::vector<LoadedPosition>& positions) {
  const std::size_t loads = problem.loads.size();
  const double left = degree == 1 ? 1 / (level_ratio - 1) : 1;
  std::vector<double> difference(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    difference[i] = left * std::abs(coarser[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
  // Along the mesh cycle the difference changes its sign here and there, where it says nothing about the error: the
  // largest of a sixteenth of a cycle to either side counts.
  const auto along = static_cast<std::ptrdiff_t>(positions.size() / loads);
  const std::ptrdiff_t reach = (problem.phases + 15) / 16;
  double worst = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    auto& entry = positions[i].entry;
    const auto at = static_cast<std::ptrdiff_t>(i / loads);
    for (std::ptrdiff_t k = at - reach; k <= at + reach; ++k) {
      // The last position is the first of the next cycle; a table that repeats closes on itself.
      const std::ptrdiff_t wrapped = (k + along - 1) % (along - 1);
      entry.error_relative = std::max(entry.error_relative, difference[wrapped * loads + i % loads]);
    }
    if (i % loads == loads / 2) worst = std::max(worst, entry.error_relative);
  }
  return worst;
}

}  // namespace

LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings) {
  check_problem(problem, settings.rung);
  if (settings.rung == Rung::closed_form) return solve_closed_form(problem, settings);
  const FlankContact flanks(solved_pair(problem.pair));
  const bool resolved = settings.rung == Rung::resolved_plane || settings.rung == Rung::resolved_solid;
  const bool solid = settings.rung == Rung::solid || settings.rung == Rung::resolved_solid;
  const int last_level = solid ? last_solid_level : last_plane_level;
  const int first_level = settings.level.value_or(1);
  if (first_level < 1 || first_level > last_level)
    throw InputError(fmt::format("level {} is not available: 1 to {} are", first_level, last_level));

  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0, saved_seconds = 0, worst = 0;
  int condensed_teeth = 0, reused_teeth = 0;
  const auto solve_level = [&](int level) {
    auto solved =
        (resolved ? solve_resolved_level : solve_condensed_level)(problem, settings, flanks, level, [&](double f) {
          if (!settings.progress) return;
          // The work grows with the number of cells, and at least the first level is solved after the one before it; a
          // further one makes the finished part smaller again.
          constexpr double growth = level_ratio * level_ratio;
          double before = 0, whole = 0;
          for (int l = first_level - 1; l <= std::max(level, first_level); ++l) {
            const double work = std::pow(growth, l);
            before += l < level ? work : l == level ? f * work : 0;
            whole += work;
          }
          settings.progress(before / whole);
        });
    mesh_seconds += solved.mesh_seconds;
    condense_seconds += solved.condense_seconds;
    contact_seconds += solved.contact_seconds;
    condensed_teeth += solved.condensed_teeth;
    reused_teeth += solved.reused_teeth;
    saved_seconds += solved.saved_seconds;
    return solved;
  };

  SolvedLevel coarser = solve_level(first_level - 1), solved;
  int level = first_level;
  for (;; ++level) {
    solved = solve_level(level);
    worst = estimate_errors(problem, settings.degree, coarser.positions, solved.positions);
    if (settings.level || worst <= settings.accuracy) break;
    if (level == last_level)
      throw SolverError(
          fmt::format("the mesh stiffness reached a relative accuracy of {:.2g} at the finest resolution, not "
                      "the wanted {:.2g}: ask for less accuracy",
                      worst, settings.accuracy));
    std::swap(coarser, solved);
  }
  auto& positions = solved.positions;
  double reciprocity = 0;
  for (const auto& p : positions) reciprocity = std::max(reciprocity, p.reciprocity_relative);

  const int loads = static_cast<int>(problem.loads.size()), cycles = repeating_teeth(problem);
  const std::size_t table_size = static_cast<std::size_t>(cycles) * problem.phases * loads;
  std::vector<double> ring_angles;
  std::vector<StiffnessEntry> entries;
  entries.reserve(table_size);
  for (std::size_t i = 0; i < table_size; ++i) entries.push_back(positions[i].entry);
  ring_angles.reserve(cycles);
  for (int c = 0; c < cycles; ++c)
    ring_angles.push_back(positions[static_cast<std::size_t>(c) * problem.phases * loads].ring_angle);
  double closure = 0;
  for (int l = 0; l < loads; ++l)
    closure = std::max(closure, std::abs(positions[table_size + l].entry.lte / positions[l].entry.lte - 1));

  StiffnessTable table(problem.pair.internal() ? "ring_planet" : "sun_planet", problem.phases, std::move(ring_angles),
                       problem.loads, std::move(entries));
  LoadedMeshResult result{std::move(table), std::move(positions)};
  result.closure_relative = closure;
  result.reciprocity_relative = reciprocity;
  result.planet_sector = std::move(solved.planet_sector);
  result.wheel_sector = std::move(solved.wheel_sector);
  result.level = level;
  result.worst_error_relative = worst;
  result.unknowns = solved.unknowns;
  result.pin_stiffness = solved.pin_stiffness;
  result.pin_angles = std::move(solved.pin_angles);
  result.slice_edges = std::move(solved.slice_edges);
  result.stress_curves = std::move(solved.stress_curves);
  result.mesh_seconds = mesh_seconds;
  result.condense_seconds = condense_seconds;
  result.contact_seconds = contact_seconds;
  result.condensed_teeth = condensed_teeth;
  result.reused_teeth = reused_teeth;
  result.saved_seconds = saved_seconds;
  return result;
}

}  // namespace annulus::fem
