#include "app/model/cost_actual.h"

#include <fmt/format.h>

#include <algorithm>

#include "fem/cost_size.h"

namespace annulus::app {

std::optional<CostRun> actual_mesh(CostRun size, const MeshResult& mesh) {
  if (mesh.reused || !mesh.model.computed()) return std::nullopt;
  size.level = static_cast<int>(mesh.fact("level"));
  size.degree = static_cast<int>(mesh.fact("degree"));  // quadratic elements may have followed linear ones
  size.levels = mesh.model.settings.level ? 2 : size.level + 1;
  if (const auto follow = quadratic_size(mesh.model); follow && size.degree == 2) size.before_s = follow->before_s;
  size.unknowns = mesh.fact("unknowns");
  size.supports = fem::support_forces(*mesh.model.problem, mesh.model.settings, size.level);
  size.wall_s = mesh.fact("mesh_seconds") + mesh.fact("condense_seconds") + mesh.fact("contact_seconds");
  // Teeth that were condensed before would make the machine look fast.
  if (mesh.fact("reused_teeth") == 0) size.processor_s = mesh.fact("processor_seconds");
  return size;
}

CostRun actual_time(CostRun size, double seconds) {
  size.wall_s = seconds;
  return size;
}

PlanCost actual_costs(const SystemRun& run) {
  PlanCost cost = run.plan.cost;
  for (auto& step : cost.steps) {
    step.actual = run.actual(step);
    // Reused responses took no time: neither may the prediction have one for them.
    if (const auto study = run.studies.times.find(step.label);
        step.kind == CostKind::studies && study != run.studies.times.end())
      step.predicted.seconds *= study->second.computed;
  }
  std::erase_if(cost.steps, [](const CostStep& step) { return !step.actual; });
  // Where nothing was computed there is nothing to compare.
  if (std::all_of(cost.steps.begin(), cost.steps.end(), [](const CostStep& s) { return s.kind == CostKind::files; }))
    cost.steps.clear();
  return cost;
}

void keep_costs(const PlanCost& done) {
  std::vector<CostRun> runs;
  for (const auto& step : done.steps)
    if (step.kind != CostKind::studies) runs.push_back(*step.actual);
  learn_pace(runs);
}

namespace {

/// Times depend on what else the machine does: they stand with the cost, and not among what is known of the results.
std::string far_off(const PlanCost& done) {
  constexpr double far = 2, short_time = 10;  // s
  const double predicted = done.seconds(), actual = done.actual_seconds();
  if (!(std::max(actual, predicted) >= short_time) || !(predicted > 0)) return "";
  if (actual > far * predicted) return fmt::format("; {:.2g} times as long as predicted", actual / predicted);
  return predicted > far * actual ? fmt::format("; {:.2g} of the predicted time", actual / predicted) : "";
}

}  // namespace

std::string cost_sentence(const SystemRun& run) {
  const auto& done = run.cost;
  if (done.empty()) return "";
  const auto meshes = [](const PlanCost& cost) {
    return std::count_if(cost.steps.begin(), cost.steps.end(),
                         [](const CostStep& step) { return step.kind == CostKind::mesh; });
  };
  if (meshes(done) < meshes(run.plan.cost))
    return fmt::format("predicted {}, actual {} for what was not reused{}", duration_text(done.seconds()),
                       duration_text(done.actual_seconds()), far_off(done));
  return fmt::format("predicted {} and {}, actual {} and {}{}", duration_text(done.seconds()),
                     memory_text(done.peak_MB()), duration_text(done.actual_seconds()), memory_text(run.peak_memory_MB),
                     far_off(done));
}

Json cost_json(const PlanCost& done) {
  Json json = {{"predicted_s", json_number(done.seconds())},
               {"actual_s", json_number(done.actual_seconds())},
               {"predicted_peak_MB", json_number(done.peak_MB())}};
  for (const auto& step : done.steps) {
    json["steps"].push_back(
        {{"step", to_text(step.kind)},
         {"name", step.label},
         {"predicted_s", json_number(step.predicted.seconds)},
         {"actual_s", step.actual->seconds()},
         {"law", step.kind == CostKind::files || step.kind == CostKind::studies ? to_text(step.kind)
                                                                                : cost_law(step.actual->work).name},
         {"degree", step.actual->degree},
         {"level", step.actual->level},
         {"levels", step.actual->levels},
         {"unknowns", step.actual->unknowns},
         {"contacts", step.actual->contacts},
         {"supports", step.actual->supports},
         {"motion_s", json_number(step.actual->motion_s)}});
    if (step.actual->processor_s > 0) json["steps"].back()["processor_s"] = step.actual->processor_s;
  }
  return json;
}

}  // namespace annulus::app
