#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/model/gear_system.h"
#include "app/model/system_run.h"
#include "app/model/table_errors.h"
#include "app/sections/report_parts.h"
#include "app/study/summary_studies.h"

/// What a run, its summary and its report are for a kind that has nothing beyond its lumped models: results with the
/// errors of the tables, and a page with the sections that all kinds have.
namespace annulus::app {

namespace {

dynamics::Evaluation evaluation_of(const LumpedModel& model, const std::vector<FigureSpec>& specs) {
  const auto point = model.answer(Answer::all);
  dynamics::Evaluation evaluation;
  for (const auto& spec : specs)
    if (const double value = point.value(spec.key); std::isfinite(value)) evaluation.figures.set(spec.key, {value, 0});
  evaluation.outcome.steady = point.value("steady") != 0;
  return evaluation;
}

std::string value_text(const FigureSpec& spec, const Figure& figure) {
  return measured(figure.value * spec.scale, std::isfinite(figure.error) ? figure.error * spec.scale : 0) +
         (spec.unit.empty() ? "" : " " + spec.unit);
}

}  // namespace

std::unique_ptr<RunResponse> GearSystem::respond(const SystemRun& run, std::size_t variant,
                                                 const RunOptions& /*options*/) const {
  const auto& specs = system_kind(scene_.stage.kind).model_figures();
  const auto evaluate = [&](const std::vector<const MeshResult*>& tables) {
    return evaluation_of(*model(variant, tables), specs);
  };
  const auto tables = run.tables_of(variant);
  auto response = std::make_unique<RunResponse>();
  response->figures = with_table_errors(evaluate(tables), tables, evaluate,
                                        {.simulation = {}, .seeks_steady_state = true, .nominal_alike = true});
  return response;
}

Json GearSystem::summary(const SystemRun& run) const {
  Json json = Json::object();
  for (const auto& q : run.plan.quantities) json["derived"][q.key] = json_number(q.value);
  for (std::size_t i = 0; i < run.studies.variants.size(); ++i)
    json["studies"][run.studies.variants[i]] = variant_studies_json(run.studies, i);
  return json;
}

std::string GearSystem::text(const SystemRun& run) const {
  std::string text;
  const auto& specs = system_kind(scene_.stage.kind).figures();
  for (const auto& variant : run.variants()) {
    if (!variant.name.empty()) text += variant.name + "\n";
    for (const auto& spec : specs)
      if (const auto* entry = variant.figures.find(spec.key))
        text += fmt::format("{:<60} {}\n", spec.title, value_text(spec, entry->figure));
  }
  return text;
}

Page GearSystem::report(const SystemRun& run) const {
  const auto all = run.variants();
  PageTable results{.head = {"result"}, .style = PageTable::Style::numbers};
  for (const auto& variant : all) results.head.emplace_back(variant.name.empty() ? "value" : variant.name);
  for (const auto& spec : system_kind(scene_.stage.kind).figures()) {
    std::vector<Text> row = {spec.title};
    bool known = false;
    for (const auto& variant : all) {
      const auto* entry = variant.figures.find(spec.key);
      known = known || entry != nullptr;
      row.emplace_back(entry ? value_text(spec, entry->figure) : "–");
    }
    if (known) results.rows.push_back(std::move(row));
  }
  std::vector<std::pair<std::string, const MeshResult*>> solved;
  for (const auto* mesh : run.meshes()) solved.emplace_back(mesh->model.label(), mesh);
  const Section key_results{"results", "Results", results},
      pictures{"meshes", "Meshes", mesh_pictures(solved) + stiffness_errors(solved)},
      quality{"quality", "Checks and cost", mesh_checks(solved) + cost_blocks(run)};
  return scene_page(scene_, describe(), {},
                    {{key_results, pictures, fields_section(solved)},
                     study_sections(scene_, run.studies),
                     {model_section(run.plan), inputs_section(run.plan), quality}});
}

}  // namespace annulus::app
