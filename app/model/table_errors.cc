#include "app/model/table_errors.h"

namespace annulus::app {

FigureSet with_table_errors(const dynamics::Evaluation& nominal, const std::vector<const MeshResult*>& tables,
                            const OnTables& evaluate, const dynamics::ComparisonOptions& way) {
  dynamics::TabulatedModel model{
      .meshes = {}, .evaluate = {}, .seeks_steady_state = way.seeks_steady_state, .nominal_alike = way.nominal_alike};
  std::vector<std::size_t> tabulated;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (!tables[i]->tabulated) continue;
    tabulated.push_back(i);
    model.meshes.push_back({tables[i]->model.label(), tables[i]->table, tables[i]->mean_stiffness().parts});
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

}  // namespace annulus::app
