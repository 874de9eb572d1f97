#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/systems/planetary/study_point.h"

namespace annulus::app {

namespace {

/// The stages with rough stiffness: what periods, steps and DOFs follow from before anything is solved.
std::vector<dynamics::PlanetaryStage> rough_stages(const Scene& scene, const GearGeometry& geometry) {
  Scene rough = scene;
  for (auto* mesh : {&rough.sun_planet, &rough.ring_planet}) {
    const double mean = rough_stiffness(scene, *mesh);
    const bool jumps = mesh->stiffness == StiffnessShape::rectangular;
    if (jumps) continue;
    *mesh = {};
    mesh->stiffness = StiffnessShape::constant;
    mesh->mean = mean;
  }
  // A prescribed stiffness reads no table: any will do.
  StiffnessTable any(sun_planet, 4, {0.0}, {1.0}, std::vector<StiffnessEntry>(4, {0, 1, 1, 1, 0}));
  const MeshResult none{.model = {}, .table = std::move(any)};
  std::vector<dynamics::PlanetaryStage> stages;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) stages.push_back(make_stage(rough, geometry, i, none, none));
  return stages;
}

/// Mesh cycles after which the response of each ring repeats, by its errors and supports; at most as many as are
/// integrated.
std::vector<int> period_cycles(const Scene& scene, const GearGeometry& geometry) {
  // The period follows from errors and tables, not from stiffness.
  const auto models = mesh_models(scene, geometry);
  const auto stages = rough_stages(scene, geometry);
  std::vector<int> periods;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& stage = stages[i];
    const int period = std::lcm(stage.error_period(), models[i + 1].positions);
    periods.push_back(std::min(period, std::max(simulation_options(scene, stage).max_window_cycles, 4000)));
  }
  return periods;
}

/// Time integration of the response of each ring, s: of `mesh_cycles`, else of one error period that confirms.
std::vector<double> integration_seconds(const Scene& scene, const GearGeometry& geometry) {
  const auto periods = period_cycles(scene, geometry);
  std::vector<double> seconds;
  for (const auto& stage : rough_stages(scene, geometry)) {
    const auto options = simulation_options(scene, stage);
    const auto system = assemble(stage);
    const double cycles = dynamics::integrated_cycles(system, stage.mesh_frequency(), periods[seconds.size()], options);
    seconds.push_back(dynamics::integration_seconds(system, stage.mesh_frequency(), cycles, options.integrator));
  }
  return seconds;
}

}  // namespace

double planetary_response_seconds(const Scene& scene, const GearGeometry& geometry) {
  double seconds = 0;
  for (const int period : period_cycles(scene, geometry))
    seconds += dynamics::point_seconds(scene.stage.planets, period);
  // Studies integrate in time only where a number of cycles is asked for.
  if (scene.dynamics->mesh_cycles)
    for (const double integrated : integration_seconds(scene, geometry)) seconds += integrated;
  return seconds;
}

std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                 const std::vector<MeshModel>& meshes) {
  if (!scene.dynamics) return {};
  std::vector<std::string> elastic;
  bool computed = false;
  for (const auto& model : meshes) {
    if (!model.computed()) continue;
    computed = true;
    // A ring held all around its outside has no modes as low as the stage's.
    if (may_be_coupled(scene, model) && scene.dynamics->rim_coupling != RimCoupling::statical &&
        !fem::held_outside(model.problem->structure))
      elastic.push_back(model.ring);
  }
  const auto periods = period_cycles(scene, geometry);
  const auto integrations = integration_seconds(scene, geometry);
  // With tables their errors are carried through: a base, both meshes stiffer and more rippled, half the phases.
  const double runs = computed && scene.dynamics->mesh_cycles ? 7 : 1;
  std::vector<PlannedResponse> responses;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& name = scene.rings[i].name;
    CostRun size;
    const bool modes = std::find(elastic.begin(), elastic.end(), name) != elastic.end();
    const bool integrated_in_time = motion_choice(scene.accuracy).confirm || scene.dynamics->mesh_cycles;
    size.kind = modes                ? "response_elastic"
                : !computed          ? "response_given"
                : integrated_in_time ? "response"
                                     : "response_direct";
    // A window is kept and evaluated, however many cycles lead to it.
    size.unknowns = static_cast<double>(scene.stage.planets) *
                    std::min(periods[i], scene.dynamics->mesh_cycles.value_or(periods[i]));
    responses.push_back({fmt::format("dynamics of '{}'", name), name, size, runs * integrations[i]});
  }
  return responses;
}

}  // namespace annulus::app
