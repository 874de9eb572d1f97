#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/model/stiff_supports.h"
#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/tolerance_sharing.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus::app {

namespace {

/// A ring held all around its outside has no modes as low as the stage's.
bool may_have_modes(const Scene& scene, const MeshModel& ring) {
  return may_be_coupled(scene, ring) && planetary(scene).rim_coupling != RimCoupling::statical &&
         !fem::held_outside(ring.problem->structure);
}

Work work_of_response(const Scene& scene, bool computed, const MeshModel& ring) {
  if (may_have_modes(scene, ring))
    return fem::on_single_supports(ring.problem->structure) ? Work::response_pins : Work::response_elastic;
  if (!computed) return Work::response_prescribed;
  const bool integrated =
      motion_choice(scene.accuracy).confirmation == dynamics::Confirmation::always || scene.dynamics->mesh_cycles;
  return integrated ? Work::response : Work::response_balanced;
}

/// Of one ring, from its stage with rough stiffness, constant and rippling. `tables`: computed meshes.
PlannedResponse planned_response(const Scene& scene, const dynamics::PlanetaryStage& stage,
                                 const dynamics::PlanetaryStage& rippling, int tables, const MeshModel& ring,
                                 const std::string& name) {
  const auto& asked = scene.dynamics->mesh_cycles;
  const auto options = simulation_options(scene, stage);
  // Mesh cycles after which the response repeats, at most as many as are integrated.
  const int most_cycles = std::max(options.max_window_cycles, 4000);
  const int own = stage.error_period();
  const int period = own < most_cycles ? std::min(std::lcm(own, ring.positions), most_cycles) : most_cycles;
  const auto system = assemble(stage);
  const bool sudden = tables > 0 || std::isfinite(system.next_jump(0));
  const auto stiffness = sudden ? dynamics::StiffnessCourse::sudden : dynamics::StiffnessCourse::smooth;
  auto without_search = options;
  without_search.other_motions.starts = 0;
  const auto course = dynamics::steady_course(system, stage.mesh_frequency(), period, without_search, stiffness);
  // Whether other motions are looked for depends on what excites the stage.
  const auto search = dynamics::steady_course(assemble(rippling), stage.mesh_frequency(), period, options, stiffness);
  const double searched_cycles = search.expected_search();
  const double per_cycle =
      dynamics::integration_seconds(system, stage.mesh_frequency(), 1, options.integrator, stiffness);
  // And on the unchanged tables in the same way; with and without a coupling that is left out as negligible.
  const double runs = comparisons(tables) + (tables > 0 ? 1 : 0) +
                      (may_be_coupled(scene, ring) && fem::held_outside(ring.problem->structure) ? 2 : 0);
  // The effect of the coupling, where it is found to matter: up to three responses as long as this one, or none.
  constexpr double effect_cycles = 330;
  const double cycles =
      course.cycles + runs * course.compared_cycles + (may_be_coupled(scene, ring) ? effect_cycles : 0);
  const double balances = course.balance_s * (1 + (course.compared_cycles > 0 ? 0 : runs));
  // Laws of force over deflection, of every changed table anew; those with jumps have at least twice the phases.
  constexpr double per_position = 3.3e-5, of_jumps = 2 * 2;
  const int phases = ring.computed() ? ring.problem->phases : 0;
  const double surface_s = scene.dynamics->load_dependence == dynamics::LoadDependence::table
                               ? per_position * ring.positions * phases * (runs + of_jumps)
                               : 0;
  const double once = asked ? *asked * per_cycle : 0;
  // A window is stored and evaluated, however many cycles lead to it.
  return {
      .label = fmt::format("dynamics of '{}'", name),
      .variant = name,
      .size = {.work = work_of_response(scene, tables > 0, ring),
               .unknowns = static_cast<double>(scene.stage.planets) * std::min(period, asked.value_or(period)),
               .motion_s = balances + (cycles + searched_cycles) * per_cycle + surface_s + tolerance_seconds(scene)},
      .search_s = asked ? 0 : std::max(0.0, search.possible_search_s(per_cycle) - searched_cycles * per_cycle),
      // Studies integrate in time only where a number of cycles is asked for.
      .study_s = course.balance_s + once,
      .study_search_s = asked ? 0 : searched_cycles * per_cycle,
      .sample_s = course.balance_s + once};
}

}  // namespace

dynamics::PlanetaryStage rough_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                     RoughCourse course) {
  Scene rough = scene;
  auto& gears = sun_and_planets(rough);
  gears.sun_planet = rough_mesh(scene, gears.sun_planet, narrower_face(scene, gears.sun, gears.planet), course);
  auto& stage = planetary(rough);
  stage.ring_planet =
      rough_mesh(scene, stage.ring_planet, narrower_face(scene, gears.planet, stage.rings.front()), course);
  const auto none = unread_table(sun_planet);
  return make_stage(rough, geometry, ring, none, none);
}

std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                 const std::vector<MeshModel>& meshes) {
  if (!scene.dynamics) return {};
  std::vector<PlannedResponse> responses;
  for (std::size_t i = 0; i < planetary(scene).rings.size(); ++i)
    responses.push_back(planned_response(
        scene, rough_stage(scene, geometry, i), rough_stage(scene, geometry, i, RoughCourse::rippling),
        meshes.front().computed() + meshes.at(i + 1).computed(), meshes.at(i + 1), planetary(scene).rings[i].name));
  return responses;
}

}  // namespace annulus::app
