#include "app/systems/two_k_v/two_k_v_lumped_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "app/tradeoff/model_changes.h"
#include "core/errors.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"

namespace annulus::app {

namespace {

FigureSet steady_reducer_figures(const TwoKVModels& models, const dynamics::SimulationOptions& options) {
  const auto response = dynamics::simulate(models.moving, options);
  if (!response.steady) throw SolverError("the motion does not become periodic");
  return evaluation_of(models, response).figures;
}

}  // namespace

ModelWays two_k_v_ways(const Scene& scene, const TwoKVTables& tables) {
  const auto models = two_k_v_models(scene, tables);
  auto simulation = two_k_v_simulation(scene, models.moving);
  simulation.keep_series = false;
  const auto id = [&](const TwoKVModels& m, const dynamics::SimulationOptions& o) { return two_k_v_id(m, o, tables); };
  WaysOf<TwoKVModels> of(models, simulation, id, steady_reducer_figures);
  of.add(shooting_settings());
  return {.as_run = {.id = id(models, simulation),
                     .figures = [models, simulation] { return steady_reducer_figures(models, simulation); }},
          .others = of.list()};
}

}  // namespace annulus::app
