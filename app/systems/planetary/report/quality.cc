#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

/// Loads that the tables of a ring do not reach.
void add_loads_beyond(List& list, const std::string& where, const MeshResult& mesh, const dynamics::DynamicResponse& f,
                      const dynamics::MeshKindResult& kind) {
  if (mesh.table.loads().size() < 2) return;
  double factor = 0;
  for (const auto& branch : kind.branches) factor = std::max(factor, branch.dynamic_factor_max.value);
  const double largest = factor * f.mean_mesh_force, tabulated = mesh.table.loads().back();
  if (largest > tabulated)
    list.items.emplace_back(fmt::format(
        "{}: forces up to {:.4g} kN lie beyond the tabulated {:.4g} kN, where the law continues with its tangent.",
        where, largest / 1e3, tabulated / 1e3));
}

}  // namespace

Section quality_section(const RunResult& result) {
  std::vector<NamedOutcome> responses;
  List beyond;
  for (const auto* ring : rings_with_response(result)) {
    const auto& f = ring->response->figures;
    responses.push_back({ring->name, &f, f.force_balance_relative});
    add_loads_beyond(beyond, ring->name + ", sun meshes", result.sun_mesh, f, f.sun_planet);
    add_loads_beyond(beyond, ring->name + ", ring meshes", ring->mesh, f, f.ring_planet);
  }
  Blocks blocks = mesh_checks(sun_then_rings(result, "ring mesh, ")) + solution_checks(responses);
  if (!beyond.items.empty()) blocks += beyond;
  return {"quality", "Checks and cost", blocks + cost_blocks(result)};
}

}  // namespace annulus::app
