#include "app/model/cost_actual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/json.h"
#include "fem/cost_size.h"

namespace annulus::app {

std::optional<CostRun> actual_mesh(CostRun size, const MeshResult& mesh) {
  if (mesh.reused || !mesh.model.computed()) return std::nullopt;
  const auto fact = [&](const char* name) {
    const double value = mesh.fact(name);
    return std::isfinite(value) ? value : 0.0;
  };
  size.level = static_cast<int>(fact("level"));
  size.degree = static_cast<int>(fact("degree"));  // quadratic elements may have followed linear ones
  size.levels = mesh.model.settings.level ? 2 : size.level + 1;
  size.unknowns = fact("unknowns");
  if (size.level > 0 && mesh.model.problem)
    size.supports = fem::support_forces(*mesh.model.problem, mesh.model.settings, size.level);
  size.error = fact("worst_error_relative");
  size.body_s = fact("mesh_seconds") + fact("condense_seconds");
  size.contact_s = fact("contact_seconds");
  size.saved_s = fact("saved_seconds");
  return size;
}

CostRun actual_time(CostRun size, double seconds) {
  size.body_s = seconds;
  return size;
}

PlanCost actual_costs(const SystemRun& run) {
  PlanCost cost = run.plan.cost;
  for (auto& step : cost.steps)
    if (step.kind != CostKind::studies) step.actual = run.actual(step);
  return cost.done();
}

void keep_costs(const PlanCost& done) {
  std::vector<CostRun> runs;
  for (const auto& step : done.steps)
    // A long time integration is predicted from its steps: it says nothing about the laws of all others.
    if (step.actual && step.integration_s < 0.2 * step.predicted.seconds && step.actual->seconds() > 0 &&
        std::isfinite(step.actual->saved_s)) {
      // What it would have cost without teeth of others.
      runs.push_back(*step.actual);
      runs.back().body_s += step.actual->saved_s;
    }
  add_user_costs(user_costs_file(), runs);
}

std::string cost_sentence(const SystemRun& run) {
  const auto& planned = run.plan.cost;
  const auto& done = run.cost;
  if (done.empty()) return "";
  const auto meshes = [](const PlanCost& cost) {
    return std::count_if(cost.steps.begin(), cost.steps.end(),
                         [](const CostStep& step) { return step.kind == CostKind::mesh; });
  };
  if (meshes(done) < meshes(planned))
    return fmt::format("predicted {}, actual {} for what was not reused", duration_text(done.seconds()),
                       duration_text(done.actual_seconds()));
  return fmt::format("predicted {} and {}, actual {} and {}", duration_text(done.seconds()),
                     memory_text(done.peak_MB()), duration_text(done.actual_seconds()),
                     memory_text(run.peak_memory_MB));
}

Json cost_json(const PlanCost& done) {
  Json json = {{"predicted_s", json_number(done.seconds())},
               {"actual_s", json_number(done.actual_seconds())},
               {"predicted_peak_MB", json_number(done.peak_MB())}};
  for (const auto& step : done.steps)
    json["steps"].push_back({{"step", to_text(step.kind)},
                             {"name", step.label},
                             {"predicted_s", json_number(step.predicted.seconds)},
                             {"actual_s", step.actual->seconds()}});
  return json;
}

}  // namespace annulus::app
