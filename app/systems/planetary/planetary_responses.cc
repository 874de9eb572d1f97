#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/model/stiff_supports.h"
#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/shared/mesh_names.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus::app {

namespace {

Work work_of_response(const Scene& scene, bool computed, const MeshModel& ring) {
  // A ring held all around its outside has no modes as low as the stage's.
  if (may_be_coupled(scene, ring) && scene.dynamics->rim_coupling != RimCoupling::statical &&
      !fem::held_outside(ring.problem->structure))
    return fem::on_single_supports(ring.problem->structure) ? Work::response_pins : Work::response_elastic;
  if (!computed) return Work::response_prescribed;
  const bool integrated =
      motion_choice(scene.accuracy).confirmation == dynamics::Confirmation::always || scene.dynamics->mesh_cycles;
  return integrated ? Work::response : Work::response_balanced;
}

/// Of one ring, from its stage with rough stiffness.
PlannedResponse planned_response(const Scene& scene, const dynamics::PlanetaryStage& stage, bool computed,
                                 const MeshModel& ring, const std::string& name) {
  const auto& asked = scene.dynamics->mesh_cycles;
  const auto options = simulation_options(scene, stage);
  // Mesh cycles after which the response repeats, at most as many as are integrated.
  const int period =
      std::min(std::lcm(stage.error_period(), ring.positions), std::max(options.max_window_cycles, 4000));
  const auto system = assemble(stage);
  const double cycles = dynamics::integrated_cycles(system, stage.mesh_frequency(), period, options);
  const double once = dynamics::integration_seconds(system, stage.mesh_frequency(), cycles, options.integrator);
  // Their errors are propagated through tables: a base, both meshes stiffer and more rippled, half the phases.
  const double runs = computed && asked ? 7 : 1;
  // Measured with five planets and 55 mesh cycles: 50 ms by harmonic balance. Studies integrate in time only where a
  // number of cycles is asked for.
  constexpr double per_cycle_and_planet = 2e-4;
  const double balance = per_cycle_and_planet * scene.stage.planets * std::max(20, period);
  // A window is stored and evaluated, however many cycles lead to it.
  return {.label = fmt::format("dynamics of '{}'", name),
          .ring = name,
          .size = {.work = work_of_response(scene, computed, ring),
                   .unknowns = static_cast<double>(scene.stage.planets) * std::min(period, asked.value_or(period)),
                   .integration_s = runs * once},
          .study_s = balance + (asked ? once : 0)};
}

}  // namespace

std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                 const std::vector<MeshModel>& meshes) {
  if (!scene.dynamics) return {};
  const bool computed = std::any_of(meshes.begin(), meshes.end(), [](const MeshModel& m) { return m.computed(); });
  const Scene rough = with_rough_stiffness(scene, {&Scene::sun_planet, &Scene::ring_planet});
  const auto none = unread_table(sun_planet);
  std::vector<PlannedResponse> responses;
  for (std::size_t i = 0; i < scene.rings.size(); ++i)
    responses.push_back(planned_response(scene, make_stage(rough, geometry, i, none, none), computed, meshes.at(i + 1),
                                         scene.rings[i].name));
  return responses;
}

}  // namespace annulus::app
