#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/planetary/stage_report_parts.h"

namespace annulus::app {

namespace {

/// How the response of each ring was found, and loads its tables do not reach.
List solution_notes(const RunResult& result) {
  List list;
  const auto beyond = [&](const std::string& where, const MeshResult& mesh, const dynamics::DynamicResponse& f,
                          const dynamics::MeshKindResult& kind) {
    if (mesh.table.loads().size() < 2) return;
    double factor = 0;
    for (const auto& branch : kind.branches) factor = std::max(factor, branch.dynamic_factor_max.value);
    const double largest = factor * f.mean_mesh_force, tabulated = mesh.table.loads().back();
    if (largest > tabulated)
      list.items.emplace_back(
          fmt::format("{}: forces up to {:.4g} kN lie beyond the tabulated {:.4g} kN, where the law goes on with its "
                      "tangent.",
                      where, largest / 1e3, tabulated / 1e3));
  };
  for (const auto& ring : result.rings) {
    if (!ring.response) continue;
    const auto& f = ring.response->figures;
    std::string how = "marched for the given time";
    if (f.direct)
      how = f.confirmed ? fmt::format(
                              "solved directly ({} Newton iterations; half the samples change a force by {:.1e} of "
                              "the mean) and confirmed by time integration over one window",
                              f.direct->newton_iterations, f.direct->sampling_difference)
            : f.total_cycles == 0 ? "solved directly"
            : f.direct->converged ? "marched: the direct solution was not confirmed"
                                  : "marched: the direct solution failed (" + f.direct->trouble + ")";
    list.items.emplace_back(
        fmt::format("{}: {}.{}", ring.name, how, f.integrator ? " Integrator: " + f.integrator->reason : ""));
    beyond(ring.name + ", sun meshes", result.sun_mesh, f, f.sun_planet);
    beyond(ring.name + ", ring meshes", ring.mesh, f, f.ring_planet);
  }
  return list;
}

}  // namespace

Section quality_section(const RunResult& result) {
  Blocks blocks = mesh_checks(sun_then_rings(result, "ring mesh, "));
  PageTable dynamics{.head = {"dynamics", "steady state", "evaluated window", "integrated", "force balance",
                              "energy balance", "steps"},
                     .style = PageTable::Style::numbers};
  for (const auto* ring : rings_with_response(result)) {
    const auto& f = ring->response->figures;
    const std::string steady = f.steady ? "reached" : "not reached";
    dynamics.rows.push_back(
        {ring->name, steady + (f.steady_difference ? fmt::format(" ({:.1e})", *f.steady_difference) : ""),
         fmt::format("{} mesh cycles{}", f.window_cycles, f.whole_period ? "" : ", less than an error period"),
         fmt::format("{} mesh cycles", f.total_cycles), small_text(f.force_balance_relative),
         small_text(f.energy.relative), fmt::format("{}", f.statistics.steps)});
  }
  if (!dynamics.rows.empty()) blocks += dynamics + solution_notes(result);
  return {"quality", "Checks and cost",
          blocks + cost_blocks(result.plan.cost, result.cost, result.timings, result.peak_memory_MB)};
}

}  // namespace annulus::app
