#include "app/run/model_run.h"

#include <cmath>
#include <utility>

#include "app/model/cost_actual.h"
#include "app/model/mesh_figures.h"
#include "app/model/run_options.h"
#include "app/sections/report_parts.h"
#include "app/study/summary_studies.h"
#include "core/parallel.h"
#include "dynamics/error_propagation/error_propagation.h"

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

FigureSet model_results(const GearSystem& system, std::size_t variant, const std::vector<const MeshResult*>& tables) {
  const auto& specs = system_kind(system.scene().stage.kind).model_figures();
  dynamics::TabulatedModel model{.meshes = {}, .evaluate = {}, .seeks_steady_state = true, .nominal_alike = true};
  std::vector<std::size_t> tabulated;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (!tables[i]->model.computed()) continue;
    tabulated.push_back(i);
    model.meshes.push_back({tables[i]->model.label(), tables[i]->table, tables[i]->mean_stiffness().parts});
  }
  model.evaluate = [&](const std::vector<StiffnessTable>& changed) {
    std::vector<MeshResult> others;
    for (std::size_t k = 0; k < tabulated.size(); ++k) {
      others.push_back(stiffness_alone(*tables[tabulated[k]]));
      others.back().table = changed[k];
    }
    auto all = tables;
    for (std::size_t k = 0; k < tabulated.size(); ++k) all[tabulated[k]] = &others[k];
    return evaluation_of(*system.model(variant, all), specs);
  };
  return dynamics::propagate_errors(evaluation_of(*system.model(variant, tables), specs), model);
}

void ModelRun::solve_meshes(const RunOptions& options) {
  const auto system = make_system(scene);
  for (const auto& mesh : system->model_meshes()) tables_.push_back(system->stiffness(mesh, options));
}

void ModelRun::respond(const RunOptions& options) {
  const auto timer = timers.measure("dynamics");
  const auto system = make_system(scene);
  responses_.resize(system->variants().size());
  const auto tables = model_tables();
  for_each_task(responses_.size(), options.threads, [&](std::size_t variant) {
    std::vector<const MeshResult*> own;
    for (const std::size_t i : system->meshes_of(variant)) own.push_back(tables.at(i));
    responses_[variant] = model_results(*system, variant, own);
  });
}

std::vector<const MeshResult*> ModelRun::meshes() const {
  std::vector<const MeshResult*> list;
  for (const auto& table : tables_)
    if (table.model.computed()) list.push_back(&table);
  return list;
}

std::vector<const MeshResult*> ModelRun::model_tables() const {
  std::vector<const MeshResult*> list;
  for (const auto& table : tables_) list.push_back(&table);
  return list;
}

std::vector<VariantFigures> ModelRun::variants() const {
  const auto system = make_system(scene);
  const auto names = system->variants();
  std::vector<VariantFigures> list;
  for (std::size_t variant = 0; variant < names.size(); ++variant) {
    FigureSet figures;
    for (const std::size_t i : system->meshes_of(variant))
      if (tables_.at(i).model.computed()) figures.add(mesh_figures(tables_[i]));
    if (!responses_.empty()) figures.add(responses_.at(variant));
    list.push_back({names[variant], std::move(figures)});
  }
  return list;
}

std::optional<CostRun> ModelRun::actual(const CostStep& step) const {
  if (step.kind == CostKind::response) return actual_time(step.size, timers.seconds("dynamics"));
  for (const auto* mesh : meshes())
    if (step.label == mesh->model.label()) return actual_mesh(step.size, *mesh);
  return std::nullopt;
}

Json ModelRun::summary() const {
  Json json = Json::object();
  for (const auto& q : plan.quantities) json["derived"][q.key] = json_number(q.value);
  for (std::size_t i = 0; i < studies.variants.size(); ++i)
    json["studies"][studies.variants[i]] = variant_studies_json(studies, i);
  return json;
}

std::string ModelRun::text() const { return key_results_text(*this); }

Page ModelRun::report() const {
  NamedMeshes solved;
  for (const auto* mesh : meshes()) solved.emplace_back(mesh->model.label(), mesh);
  return run_page(*this,
                  {.words = make_system(scene)->describe(),
                   .results = {key_results(*this, {{"", ""}}, "")},
                   .meshes = solved,
                   .sections = {{"stiffness", "Mesh stiffness", solved.empty() ? Blocks() : stiffness_blocks(solved)},
                                contact_section(solved)}});
}

}  // namespace annulus::app
