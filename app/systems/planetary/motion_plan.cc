#include <fmt/format.h>

#include <algorithm>

#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/rim_coupling.h"

namespace annulus::app {

namespace {

constexpr const char* asked = "the scene asks for it";

/// In the order of dynamics::Integrator.
constexpr const char* integrator_names[] = {
    "Cash-Karp 5(4), BDF or ESDIRK 5(4)", "Cash-Karp 5(4)", "Adams", "BDF", "Runge-Kutta 4", "ESDIRK 5(4)"};

void add_solution(std::vector<Decision>& list, const DynamicsInput& input, const MotionChoice& choice) {
  if (input.mesh_cycles) {
    list.push_back({"solution", fmt::format("{} mesh cycles in time", *input.mesh_cycles), asked});
  } else {
    list.push_back({"solution", "harmonic balance", "one error period, without integrating its transient in time"});
    list.push_back(
        {"confirmation", choice.confirm ? "by time integration" : "where contact is lost", choice.confirm_reason});
  }
  list.push_back({"samples per mesh cycle", std::to_string(choice.samples_per_cycle), choice.samples_reason});
}

void add_integrator(std::vector<Decision>& list, const DynamicsInput& input, const MotionChoice& choice) {
  list.push_back({"integrator", integrator_names[static_cast<int>(input.integrator)],
                  input.integrator == dynamics::Integrator::automatic
                      ? "where time is integrated, the cheaper one for the stiffness ratio and damping found"
                      : asked});
  if (input.steps_per_cycle)
    list.push_back({"steps per mesh cycle", std::to_string(*input.steps_per_cycle), asked});
  else
    list.push_back(
        input.relative_tolerance
            ? Decision{"tolerance", fmt::format("{:.0e}", *input.relative_tolerance), asked}
            : Decision{"tolerance", fmt::format("{:.0e}", choice.relative_tolerance), choice.tolerance_reason});
}

Decision coupling_decision(const Scene& scene, const std::vector<MeshModel>& meshes) {
  constexpr const char* what = "coupling of the meshes";
  if (std::any_of(meshes.begin(), meshes.end(), [&](const MeshModel& m) { return may_be_coupled(scene, m); }))
    return {what, "solved", "through the ring; taken where it changes more than the wanted accuracy"};
  return {what, "left out",
          scene.dynamics->rim_coupling == RimCoupling::none ? asked : "no ring's elasticity is solved by elements"};
}

Decision stiffness_decision(const DynamicsInput& input, const std::vector<MeshModel>& meshes) {
  constexpr const char* what = "stiffness law";
  if (std::none_of(meshes.begin(), meshes.end(), [](const MeshModel& m) { return m.computed(); }))
    return {what, "as given", "no stiffness is computed"};
  if (input.load_dependence == dynamics::LoadDependence::table)
    return {what, "follows the load", "the tables hold several loads"};
  return {what, "of the nominal load", asked};
}

}  // namespace

std::vector<Decision> motion_decisions(const Scene& scene, const std::vector<MeshModel>& meshes) {
  const auto choice = motion_choice(scene.accuracy);
  std::vector<Decision> list;
  add_solution(list, *scene.dynamics, choice);
  add_integrator(list, *scene.dynamics, choice);
  list.push_back(stiffness_decision(*scene.dynamics, meshes));
  list.push_back(coupling_decision(scene, meshes));
  return list;
}

}  // namespace annulus::app
