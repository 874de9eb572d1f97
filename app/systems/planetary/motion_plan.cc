#include <fmt/format.h>

#include <algorithm>

#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/rim_coupling.h"

namespace annulus::app {

namespace {

constexpr const char* asked_for = "the scene asks for it";

/// In the order of dynamics::Integrator.
constexpr const char* integrator_names[] = {
    "Cash-Karp 5(4), BDF or ESDIRK 5(4)", "Cash-Karp 5(4)", "Adams", "BDF", "Runge-Kutta 4", "ESDIRK 5(4)"};

Decision coupling_decision(const Scene& scene, const std::vector<MeshModel>& meshes) {
  constexpr const char* what = "coupling of the meshes";
  if (std::any_of(meshes.begin(), meshes.end(), [&](const MeshModel& m) { return may_be_coupled(scene, m); }))
    return {what, "solved", "through the ring; applied beyond a tenth of the wanted accuracy"};
  return {what, "left out",
          planetary(scene).rim_coupling == RimCoupling::none ? asked_for : "no ring is solved with finite elements"};
}

Decision stiffness_decision(const DynamicsInput& input, const std::vector<MeshModel>& meshes) {
  constexpr const char* what = "stiffness law";
  if (std::none_of(meshes.begin(), meshes.end(), [](const MeshModel& m) { return m.computed(); }))
    return {what, "as prescribed", "no stiffness is computed"};
  if (input.load_dependence == dynamics::LoadDependence::table)
    return {what, "follows the load", "the tables hold several loads"};
  return {what, "of the nominal load", asked_for};
}

}  // namespace

std::vector<Decision> motion_decisions(const Scene& scene, const std::vector<MeshModel>& meshes) {
  const auto& input = *scene.dynamics;
  const auto choice = motion_choice(scene.accuracy);
  std::vector<Decision> list;
  const auto add = [&](const char* what, std::string decided, std::string reason) {
    list.push_back({what, std::move(decided), std::move(reason)});
  };
  if (input.mesh_cycles) {
    add("solution", fmt::format("{} mesh cycles in time", *input.mesh_cycles), asked_for);
  } else {
    add("solution", "harmonic balance", "one error period, without integrating its transient in time");
    const bool always = choice.confirmation == dynamics::Confirmation::always;
    add("confirmation", always ? "by time integration" : "where needed", choice.confirm_reason);
  }
  add("samples per mesh cycle", std::to_string(choice.samples_per_cycle), choice.samples_reason);
  const bool automatic = input.integrator == dynamics::Integrator::automatic;
  add("integrator", integrator_names[static_cast<int>(input.integrator)],
      automatic ? "for time integration, the cheaper one for the computed stiffness ratio and damping" : asked_for);
  if (input.steps_per_cycle)
    add("steps per mesh cycle", std::to_string(*input.steps_per_cycle), asked_for);
  else
    add("tolerance", fmt::format("{:.0e}", input.relative_tolerance.value_or(choice.relative_tolerance)),
        input.relative_tolerance ? asked_for : choice.tolerance_reason);
  if (input.starts > 0 && !input.mesh_cycles)
    add("other motions", fmt::format("looked for from {} starts", input.starts),
        "where a bound of the vibration comes within half of the mean deflection: backlash may then allow several");
  list.push_back(stiffness_decision(input, meshes));
  list.push_back(coupling_decision(scene, meshes));
  return list;
}

}  // namespace annulus::app
