#include "app/model/table_errors.h"

#include <cmath>

#include "app/model/gear_system.h"
#include "fem/choice/table_choice.h"

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

/// See TabulatedMesh. Stiffness rises and falls by most of its jump within half of the way.
double uptake_of(const MeshModel& model) {
  if (!model.problem) return 0;
  constexpr double most = 0.5, force = 1;  // N
  return most * fem::load_uptake(force, model.problem->face_width, model.problem->pair.pinion().parameters().module,
                                 model.problem->materials.youngs_modulus());
}

}  // namespace

FigureSet with_table_errors(const dynamics::Evaluation& nominal, const std::vector<const MeshResult*>& tables,
                            const OnTables& evaluate, const dynamics::ComparisonOptions& way) {
  dynamics::TabulatedModel model{
      .meshes = {}, .evaluate = {}, .seeks_steady_state = way.seeks_steady_state, .nominal_alike = way.nominal_alike};
  std::vector<std::size_t> tabulated;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (!tables[i]->tabulated) continue;
    tabulated.push_back(i);
    model.meshes.push_back({.name = tables[i]->model.label(),
                            .table = tables[i]->table,
                            .mean_stiffness_parts = tables[i]->mean_stiffness().parts,
                            .uptake = uptake_of(tables[i]->model)});
  }
  model.evaluate = [&](const std::vector<StiffnessTable>& changed) {
    std::vector<MeshResult> others;
    others.reserve(tabulated.size());
    auto all = tables;
    for (std::size_t k = 0; k < tabulated.size(); ++k) {
      auto& other = others.emplace_back(stiffness_alone(*tables[tabulated[k]]));
      other.table = changed[k];
      all[tabulated[k]] = &other;
    }
    return evaluate(all);
  };
  return dynamics::propagate_errors(nominal, model);
}

FigureSet model_results(const GearSystem& system, std::size_t variant, const std::vector<const MeshResult*>& tables) {
  const auto& specs = system_kind(system.scene().stage.kind).model_figures();
  const auto evaluate = [&](const std::vector<const MeshResult*>& changed) {
    return evaluation_of(*system.model(variant, changed), specs);
  };
  return with_table_errors(evaluate(tables), tables, evaluate,
                           {.simulation = {}, .seeks_steady_state = true, .nominal_alike = true});
}

void add_change(FigureSet& figures, const FigureSet& before, const FigureSet& after) {
  const auto known = figures;
  for (const auto& entry : known.entries()) {
    auto parts = entry.parts;
    parts.model += std::abs(after.value(entry.key) - before.value(entry.key));
    figures.set(entry.key, {entry.figure.value, parts.total()}, parts);
  }
}

}  // namespace annulus::app
