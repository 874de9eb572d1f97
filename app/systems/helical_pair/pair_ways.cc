#include <utility>

#include "app/systems/helical_pair/pair_lumped_model.h"
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

ModelWays pair_ways(const LumpedPair& lumped) {
  const auto id = [lumped](const HelicalPair& pair, const dynamics::SimulationOptions& options) {
    auto other = lumped;
    other.pair = pair;
    return other.id(options);
  };
  auto simulation = pair_simulation(lumped.scene);
  simulation.keep_series = false;
  auto unconfirmed = simulation;
  unconfirmed.confirmation = dynamics::Confirmation::where_needed;
  WaysOf<HelicalPair> of(lumped.pair, simulation, id, steady_pair_figures);
  of.add(motion_settings(lumped.pair.mesh_frequency(), lumped.pair.error_period()));
  of.add(rigid_changes_of_pair());
  ModelWays ways{.as_run = {.id = lumped.id(unconfirmed)}, .others = of.list()};
  ways.as_run.figures = [lumped, unconfirmed] {
    auto response = dynamics::evaluate_pair(lumped.pair, unconfirmed);
    return propagated_pair_errors(lumped, unconfirmed, response);
  };
  return ways;
}

}  // namespace annulus::app
