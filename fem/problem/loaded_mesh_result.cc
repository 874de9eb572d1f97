#include "fem/problem/loaded_mesh_result.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace annulus::fem {

double BodyField::von_mises(std::size_t vertex) const {
  const auto& [xx, yy, zz, xy, yz, zx] = stress[vertex];
  return std::sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 +
                   3 * (xy * xy + yz * yz + zx * zx));
}

SolveCost& SolveCost::operator+=(const SolveCost& other) {
  mesh_seconds += other.mesh_seconds;
  condense_seconds += other.condense_seconds;
  contact_seconds += other.contact_seconds;
  condensed_teeth += other.condensed_teeth;
  reused_teeth += other.reused_teeth;
  return *this;
}

LoadedMeshResult tabulated(const LoadedMeshProblem& problem, std::vector<LoadedPosition> positions) {
  const std::size_t loads = problem.loads.size();
  const auto cycles = static_cast<std::size_t>(problem.structure.repeating_teeth(problem.pair.wheel().teeth()));
  const std::size_t table_size = cycles * problem.phases * loads;
  std::vector<StiffnessEntry> entries;
  entries.reserve(table_size);
  for (std::size_t i = 0; i < table_size; ++i) entries.push_back(positions[i].entry);
  std::vector<double> ring_angles;
  ring_angles.reserve(cycles);
  for (std::size_t c = 0; c < cycles; ++c) ring_angles.push_back(positions[c * problem.phases * loads].ring_angle);
  StiffnessTable table(problem.name, problem.phases, std::move(ring_angles), problem.loads, std::move(entries));
  LoadedMeshResult result(std::move(table), std::move(positions));
  for (const auto& p : result.positions)
    result.reciprocity_relative = std::max(result.reciprocity_relative, p.reciprocity_relative);
  for (std::size_t l = 0; l < loads; ++l)
    result.closure_relative =
        std::max(result.closure_relative,
                 std::abs(result.positions[table_size + l].entry.lte / result.positions[l].entry.lte - 1));
  return result;
}

}  // namespace annulus::fem
