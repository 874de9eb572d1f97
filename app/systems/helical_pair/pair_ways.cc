#include <utility>

#include "app/systems/helical_pair/pair_lumped_model.h"
#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/helical_pair/pair_table_errors.h"
#include "app/tradeoff/model_changes.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

using dynamics::HelicalPair;

const std::vector<RigidChange<HelicalPair>>& rigid_changes_of_pair() {
  static const std::vector<RigidChange<HelicalPair>> list = {
      {"shafts and bearings rigid across the axis",
       [](HelicalPair& p) {
         return std::vector{&p.pinion.bearing_transverse, &p.wheel.bearing_transverse};
       }},
      {"shafts and bearings rigid along the axis", [](HelicalPair& p) {
         return std::vector{&p.pinion.bearing_axial, &p.wheel.bearing_axial};
       }}};
  return list;
}

FigureSet steady_pair_figures(const HelicalPair& pair, const dynamics::SimulationOptions& options) {
  const auto response = dynamics::evaluate_pair(pair, options);
  if (!response.steady) throw SolverError("the motion does not become periodic");
  auto figures = dynamics::figures(response);
  figures.add(dynamics::frequency_figures(pair));
  return figures;
}

}  // namespace

ModelWays pair_ways(const Scene& scene, const PairGeometry& geometry, const PairMesh& mesh) {
  PairRunResult result(scene);
  result.mesh = mesh;
  result.pair = make_pair(scene, geometry, pair_excitation(scene, geometry, mesh), pair_errors(scene).amplitude);
  const auto id = [&](const HelicalPair& pair, const dynamics::SimulationOptions& options) {
    return pair_id(pair, options, mesh.table ? &*mesh.table : nullptr);
  };
  auto simulation = pair_simulation(scene);
  simulation.keep_series = false;
  auto unconfirmed = simulation;
  unconfirmed.confirm = false;
  WaysOf<HelicalPair> of(*result.pair, simulation, id, steady_pair_figures);
  of.add(motion_settings(result.pair->mesh_frequency(), result.pair->error_period()));
  of.add(rigid_changes_of_pair());
  ModelWays ways{.as_run = {.id = id(*result.pair, unconfirmed)}, .others = of.list()};
  ways.as_run.figures = [result, unconfirmed] {
    auto response = dynamics::evaluate_pair(*result.pair, unconfirmed);
    return carried_pair_errors(result, unconfirmed, response);
  };
  return ways;
}

}  // namespace annulus::app
