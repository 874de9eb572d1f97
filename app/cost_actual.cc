#include "app/cost_actual.h"

#include <fmt/format.h>

#include <cmath>

#include "app/report_parts.h"
#include "app/svg_plot.h"

namespace annulus::app {

namespace {

std::optional<CostRun> actual_mesh(CostRun size, const MeshResult& mesh) {
  if (mesh.reused || !mesh.model.computed()) return std::nullopt;
  const auto fact = [&](const char* name) {
    const double value = mesh.fact(name);
    return std::isfinite(value) ? value : 0.0;
  };
  size.level = static_cast<int>(fact("level"));
  size.levels = mesh.model.settings.level ? 2 : size.level + 1;
  size.unknowns = fact("unknowns");
  size.error = fact("worst_error_relative");
  size.body_s = fact("mesh_seconds") + fact("condense_seconds");
  size.contact_s = fact("contact_seconds");
  return size;
}

std::optional<CostRun> timed(CostRun size, double seconds) {
  size.body_s = seconds;
  return size;
}

}  // namespace

PlanCost actual_costs(const RunResult& result) {
  PlanCost cost = result.plan.cost;
  for (auto& step : cost.steps) {
    if (step.kind == CostKind::mesh && step.label == result.sun_mesh.model.label())
      step.actual = actual_mesh(step.size, result.sun_mesh);
    for (std::size_t i = 0; i < result.rings.size(); ++i) {
      const auto& ring = result.rings[i];
      const auto& coupling = ring.mesh.coupling;
      if (step.kind == CostKind::mesh && step.label == ring.mesh.model.label())
        step.actual = actual_mesh(step.size, ring.mesh);
      else if (step.kind == CostKind::coupling && step.ring == ring.name && coupling && !coupling->reused)
        step.actual = timed(step.size, coupling->seconds);
      else if (step.kind == CostKind::response && step.ring == ring.name && ring.response && !ring.response->reused)
        step.actual = timed(step.size, ring.response_seconds);
    }
  }
  return cost.done();
}

std::string cost_sentence(const RunResult& result) {
  const auto& cost = result.cost;
  if (cost.empty()) return "";
  std::size_t meshes = 0, planned = 0;
  for (const auto& step : cost.steps) meshes += step.kind == CostKind::mesh;
  for (const auto& step : result.plan.cost.steps) planned += step.kind == CostKind::mesh;
  if (meshes < planned)
    return fmt::format("predicted {}, actual {} for what was not reused", duration_text(cost.seconds()),
                       duration_text(cost.actual_seconds()));
  return fmt::format("predicted {} and {}, actual {} and {}", duration_text(cost.seconds()),
                     memory_text(cost.peak_MB()), duration_text(cost.actual_seconds()),
                     memory_text(result.peak_memory_MB));
}

std::string predicted_and_actual_html(const RunResult& result) {
  if (result.cost.empty()) return "";
  HtmlTable table{
      .head = {"step", "predicted time", "actual time", "predicted peak memory"}, .rows = {}, .css_class = "numbers"};
  for (const auto& step : result.cost.steps)
    table.rows.push_back({escape(step.label), duration_text(step.predicted.seconds),
                          duration_text(step.actual->seconds()),
                          step.kind == CostKind::coupling ? "–" : memory_text(step.predicted.peak_MB)});
  return "<p>Cost of the steps that were not reused, as predicted before the run and as measured: " +
         escape(cost_sentence(result)) + ".</p>\n" + html(table);
}

}  // namespace annulus::app
