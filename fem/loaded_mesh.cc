#include "fem/loaded_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/body/resolution.h"
#include "fem/closed_form/closed_form_mesh.h"
#include "fem/cost_size.h"
#include "fem/levels/error_estimate.h"
#include "fem/levels/level.h"
#include "fem/problem/problem_check.h"

namespace annulus::fem {
namespace {

/// Teeth after which the structure of the wheel repeats.
int repeating_teeth(const LoadedMeshProblem& problem) {
  return problem.structure.repeating_teeth(problem.pair.wheel().teeth());
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

}  // namespace

LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& asked) {
  check_problem(problem, asked.fidelity);
  if (asked.fidelity == Fidelity::closed_form) return solve_closed_form(problem, asked);
  LoadedMeshSettings settings = asked;
  const FlankContact flanks(solved_pair(problem.pair));
  const bool resolved = settings.fidelity == Fidelity::resolved_plane || settings.fidelity == Fidelity::resolved_solid;
  const bool solid = settings.fidelity == Fidelity::solid || settings.fidelity == Fidelity::resolved_solid;
  const int last_level = solid ? last_solid_level : last_plane_level;
  const int first_level = settings.level.value_or(1);
  if (first_level < 1 || first_level > last_level)
    throw InputError(fmt::format("level {} is not available: 1 to {} are", first_level, last_level));

  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0, saved_seconds = 0, worst = 0;
  int condensed_teeth = 0, reused_teeth = 0;
  const auto solve_level = [&](int level, const AcceptLevel& accept) {
    auto solved = (resolved ? solve_resolved_level : solve_condensed_level)(
        problem, settings, flanks, level, accept, [&](double f) {
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

  SolvedLevel coarser = solve_level(first_level - 1, {}), solved;
  int level = first_level;
  std::optional<double> difference;  // of the last two levels
  for (;; ++level) {
    bool accepted = false;
    std::optional<double> next_difference;
    const auto estimate = [&](SolvedLevel& finer) {
      const auto errors =
          estimate_errors(problem, settings, finer.contact_error, coarser.positions, finer.positions, difference);
      worst = errors.worst, next_difference = errors.difference;
      return accepted = settings.level || worst <= settings.accuracy;
    };
    solved = solve_level(level, estimate);
    if (accepted) {
      estimate(solved);  // of all positions
      break;
    }
    difference = next_difference;
    if (settings.degree == 1 && level >= last_linear_level(problem)) {
      settings.degree = 2;
      coarser = solve_level(0, {});
      level = 0, difference.reset();
      continue;
    }
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
  result.degree = settings.degree;
  result.worst_error_relative = worst;
  result.half_face = solved.half_face;
  result.unknowns = solved.unknowns;
  result.pin_stiffness = solved.pin_stiffness;
  result.pin_angles = std::move(solved.pin_angles);
  result.slice_edges = std::move(solved.slice_edges);
  result.stress_curves = std::move(solved.stress_curves);
  result.fields = std::move(solved.fields);
  result.mesh_seconds = mesh_seconds;
  result.condense_seconds = condense_seconds;
  result.contact_seconds = contact_seconds;
  result.condensed_teeth = condensed_teeth;
  result.reused_teeth = reused_teeth;
  result.saved_seconds = saved_seconds;
  return result;
}

}  // namespace annulus::fem
