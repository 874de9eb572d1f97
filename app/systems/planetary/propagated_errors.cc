#include "app/systems/planetary/propagated_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/table_errors.h"
#include "app/systems/planetary/alternative_stages.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/not_known.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

using dynamics::DynamicResponse;
using dynamics::MeshKindResult;

dynamics::Evaluation evaluation_of(const DynamicResponse& response) {
  dynamics::Evaluation evaluation{.figures = {}, .outcome = static_cast<const dynamics::SteadyOutcome&>(response)};
  dynamics::for_each_figure(response,
                            [&](const std::string& key, const Figure& figure) { evaluation.figures.set(key, figure); });
  evaluation.figures.add(response.bodies);
  return evaluation;
}

/// Whether back flanks carry at times on a table that changes from tooth to tooth.
bool on_back_flanks(const MeshKindResult& kind, const MeshResult& mesh) {
  return mesh.tabulated && mesh.table.positions() > 1 &&
         std::any_of(kind.branches.begin(), kind.branches.end(), [](const auto& b) { return b.back_flanks > 0; });
}

/// The stage with the supports of its ring half their pattern further for back flanks: where they stand is not known.
dynamics::PlanetaryStage with_moved_supports(dynamics::PlanetaryStage stage, int positions) {
  const int half = positions / 2;  // whole mesh cycles
  if (auto* table = std::get_if<dynamics::TableStiffness>(&stage.ring_mesh))
    table->back_flank_phase = table->back_flank_phase.value_or(0) + half;
  return stage;
}

/// Adds to the model's part of every error what changes from one stage to each of the others.
void add_changes(const dynamics::PlanetaryStage& here, const std::vector<dynamics::PlanetaryStage>& others,
                 const dynamics::ComparisonOptions& way, FigureSet& figures) {
  if (others.empty()) return;
  const auto on = [&](const dynamics::PlanetaryStage& stage) {
    return evaluation_of(dynamics::simulate(stage, way.simulation)).figures;
  };
  try {
    const auto before = on(here);
    for (const auto& there : others) add_change(figures, before, on(there));
  } catch (const Error& error) {  // no solution, or motions of the other stage that grow
    log::warn(fmt::format("another model of the stage: {}: its effect on the results is not known", error.what()));
    FigureSet unknown;
    for (const auto& entry : figures.entries()) unknown.set(entry.key, {not_known, not_known});
    add_change(figures, unknown, unknown);
  }
}

}  // namespace

FigureSet propagated_errors(const DynamicResponse& nominal, const dynamics::SimulationOptions& options,
                            const StageTables& tables) {
  const auto way = dynamics::comparison_options(nominal, options);
  auto found = with_table_errors(
      evaluation_of(nominal), {&tables.sun_mesh, &tables.ring_mesh},
      [&](const std::vector<const MeshResult*>& changed) {
        return evaluation_of(dynamics::simulate(tables.make(*changed.front(), *changed.back()), way.simulation));
      },
      way);
  const auto stage = tables.make(tables.sun_mesh, tables.ring_mesh);
  auto others = alternative_stages(stage, tables.sun_mesh, tables.ring_mesh);
  if (on_back_flanks(nominal.ring_planet, tables.ring_mesh))
    others.push_back(with_moved_supports(stage, tables.ring_mesh.table.positions()));
  add_changes(stage, others, way, found);
  return found;
}

void set_errors(const FigureSet& errors, DynamicResponse& response) {
  dynamics::for_each_figure(
      response, [&](const std::string& key, Figure& figure) { figure.error = errors.find(key)->parts.total(); });
  for (const auto& [key, figure, parts, spread] : errors.entries())
    if (response.bodies.find(key)) response.bodies.set(key, {figure.value, parts.total()}, parts);
}

}  // namespace annulus::app
