#include <utility>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/tradeoff/model_changes.h"
#include "core/errors.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

using Stage = dynamics::PlanetaryStage;

const std::vector<RigidChange<Stage>>& rigid_changes() {
  static const std::vector<RigidChange<Stage>> list = {
      {"sun held in place", [](Stage& s) { return std::vector{&s.sun.support}; }},
      {"ring held in place", [](Stage& s) { return std::vector{&s.ring.support}; }},
      {"held rigidly against rotation",
       [](Stage& s) {
         if (!s.held || !(s.body(*s.held).torsional_support > 0)) return std::vector<double*>{};
         return std::vector{&s.body(*s.held).torsional_support};
       }},
      {"carrier held in place", [](Stage& s) { return std::vector{&s.carrier.support}; }},
      {"planet bearings rigid", [](Stage& s) {
         std::vector<double*> stiffness;
         for (auto& bearing : s.planet_bearings) {
           if (bearing.play > 0) return std::vector<double*>{};
           for (double* one : {&bearing.radial, &bearing.tangential}) stiffness.push_back(one);
         }
         return stiffness;
       }}};
  return list;
}

FigureSet steady_figures(const Stage& stage, const dynamics::SimulationOptions& options) {
  const auto response = dynamics::simulate(stage, options);
  if (!response.steady) throw SolverError("the motion does not become periodic");
  auto figures = dynamics::figures(response);
  const auto frequencies = frequency_figures(stage_modes(stage, {}));
  for (const auto& e : frequencies.entries()) figures.set(e.key, e.figure.value);
  return figures;
}

}  // namespace

ModelWays planetary_ways(const Scene& scene, const GearGeometry& geometry, std::size_t ring, const MeshResult& sun,
                         const MeshResult& wheel) {
  auto stage = make_stage(scene, geometry, ring, sun, wheel);
  auto simulation = simulation_options(scene, stage);
  simulation.keep_series = false;
  auto unconfirmed = simulation;
  unconfirmed.confirmation = dynamics::Confirmation::where_needed;
  ModelWays ways;
  ways.as_run.id = response_id(stage, unconfirmed, sun, wheel);
  ways.as_run.figures = [&scene, &geometry, &sun, &wheel, ring, stage, unconfirmed] {
    auto response = dynamics::simulate(stage, unconfirmed);
    const auto make = [&](const MeshResult& s, const MeshResult& w) { return make_stage(scene, geometry, ring, s, w); };
    set_errors(propagated_errors(response, unconfirmed, {make, sun, wheel}), response);
    auto figures = dynamics::figures(response);
    figures.add(frequency_figures(stage_modes(stage, stiffness_errors(sun, wheel))));
    return figures;
  };

  if (wheel.coupling) stage.ring_coupling = taken_coupling(*wheel.coupling, RimCoupling::statical);
  const auto id = [&](const Stage& s, const dynamics::SimulationOptions& o) { return response_id(s, o, sun, wheel); };
  WaysOf<Stage> of(stage, simulation, id, steady_figures);
  of.add(motion_settings(stage.mesh_frequency(), stage.error_period()));
  of.add(rigid_changes());
  const auto coupled = [&](const char* how, std::shared_ptr<const RingCoupling> coupling, int samples) {
    auto changed = stage;
    changed.ring_coupling = std::move(coupling);
    of.add_changed("coupling", how, changed, samples);
  };
  if (stage.ring_coupling) coupled("planets not coupled through the ring", nullptr, finest_samples);
  if (wheel.coupling && !wheel.coupling->coupling.modes.empty() && !stage.space)
    coupled("ring with its elastic modes", taken_coupling(*wheel.coupling, RimCoupling::elastic), 64);
  ways.others = of.list();
  return ways;
}

}  // namespace annulus::app
