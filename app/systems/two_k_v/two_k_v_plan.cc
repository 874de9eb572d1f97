#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/model/stiff_supports.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_run.h"
#include "core/units.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/system/periods.h"

namespace annulus::app {

dynamics::TwoKVStage rough_two_k_v(const Scene& scene) {
  Scene rough = scene;
  auto& gears = sun_and_planets(rough);
  gears.sun_planet = rough_mesh(scene, gears.sun_planet, narrower_face(scene, gears.sun, gears.planet));
  auto& pins = two_k_v(rough).arc_pins;
  pins = rough_mesh(scene, pins, scene.stage.face_width);
  return make_two_k_v(rough, {unread_table(sun_planet), unread_table(arc_pins)}, dynamics::LoadDependence::nominal);
}

namespace {

std::vector<Quantity> two_k_v_quantities(const Scene& scene, const geometry::GearPair& pair) {
  const auto stage = two_k_v_kinematics(scene);
  std::vector<Quantity> list = {
      quantity("ratio", stage.ratio(),
               "turns of the input per turn of the output: 1 + (planet teeth / sun teeth) × pins"),
      quantity("input_speed_rpm", two_k_v(scene).output.speed * stage.ratio(), "speed of the input"),
      quantity("input_torque_Nm", two_k_v(scene).output.torque / stage.ratio(), "torque of the input, without losses"),
      quantity("crank_circle_radius_mm", stage.crank_circle_radius(),
               "from the axis to the cranks: the centre distance of sun and planets"),
      quantity("arc_teeth", stage.arc_teeth, "teeth of an arc gear, one less than pins"),
      quantity("crank_frequency_Hz", stage.crank_frequency(), "turns of the cranks against the carrier"),
      quantity("sun_mesh_frequency_Hz", stage.sun_mesh_frequency(), "mesh frequency of sun and planets"),
      quantity("arc_mesh_frequency_Hz", stage.arc_mesh_frequency(), "mesh frequency of arc teeth and pins"),
      quantity("mean_sun_mesh_force_N", stage.mean_sun_mesh_force(),
               "mean force of each sun mesh, along the line of action"),
      quantity("mean_arc_mesh_force_N", stage.mean_arc_mesh_force(),
               "mean force of each arc mesh, along the tangent of the pitch point"),
      quantity("sun_mesh_contact_ratio", pair.contact_ratio(), "contact ratio of the sun mesh"),
      quantity("sun_mesh_normal_backlash_um", pair.normal_backlash(),
               "backlash of the sun mesh along the line of action, from the profile shifts"),
      quantity("planet_tip_diameter_mm", 2 * pair.pinion().tip_radius(), "planet tip diameter"),
      quantity("sun_tip_diameter_mm", 2 * pair.wheel().tip_radius(), "sun tip diameter"),
  };
  if (const auto arc = arc_tooth_mesh(scene))
    list.push_back(quantity("shortening", arc->eccentricity * arc->pins / arc->pin_circle_radius,
                            "eccentricity × pins / radius of the pin circle: relative radius of the pitch point"));
  return list;
}

std::vector<DofPlan> two_k_v_dofs(const Scene& scene) {
  const auto held = [](const std::string& name, double support) {
    return supported_dof(name, "torsional support", support, support, "N m/rad");
  };
  const std::string planets = fmt::format("planet 1 ... {}", scene.stage.planets),
                    cranks = fmt::format("crank 1 ... {}", scene.stage.planets),
                    gears = fmt::format("arc gear 1 ... {}", two_k_v(scene).arc_gear.count);
  return {held("input u", two_k_v(scene).input.support),
          {"sun u", true, "turns between input shaft and planets"},
          {planets + " u", true, "each turns between the sun and its crank shaft"},
          {planets + " x", true, "along the circle of the cranks, in the crank's bearings"},
          {cranks + " u", true, "each turns between its planet and the arc gears"},
          {gears + " u", true, "each turns with the output"},
          {gears + " x", true, "along the circle of the eccentric"},
          held("output u", two_k_v(scene).output.support)};
}

std::vector<std::string> stiff_parts(const Scene& scene) {
  const auto stage = rough_two_k_v(scene);
  std::vector<std::string> list;
  const auto add = [&](const char* key, double given, double taken, const char* unit) {
    if (taken < given)
      list.push_back(
          fmt::format("{} = {} {unit} counts as some {} {unit}: it then deflects by less than a thousandth of the "
                      "accuracy compared with its neighbours, and a larger value changes nothing.",
                      key, to_text(given), to_text(taken, 2), fmt::arg("unit", unit)));
  };
  add("input.shaft_Nm_per_rad", *two_k_v(scene).input.shaft, stage.input_shaft, "N m/rad");
  add("crank.shaft_Nm_per_rad", *two_k_v(scene).crank.shaft, stage.crank_shaft, "N m/rad");
  add("crank.bearing_N_per_m", *two_k_v(scene).crank.bearing, stage.crank_bearing, "N/m");
  add("arc_gear.bearing_N_per_m", *two_k_v(scene).arc_gear.bearing, stage.arc_bearing, "N/m");
  return list;
}

std::vector<std::string> two_k_v_remarks(const Scene& scene, bool computed) {
  std::vector<std::string> list;
  if (computed) {
    list.emplace_back("Only the driving flanks are solved; friction is neglected.");
    list.emplace_back("All sun meshes are equal and solved once; each has its own phase in the table.");
  }
  if (compared_scene(scene))
    list.emplace_back("Prescribed stiffness is also computed, and there are results with both.");
  if (!scene.dynamics) {
    list.emplace_back("No [dynamics]: mesh stiffness only.");
    return list;
  }
  list.emplace_back(
      "The directions of the eccentrics turn with the crank: stiffness and modes change over its turn even where the "
      "mesh stiffness is constant.");
  list.emplace_back("Centrifugal and gyroscopic terms are neglected, as in the paper; the crank turns slowly.");
  if (scene.dynamics->half_backlash == 0)
    list.emplace_back("Without backlash no mesh loses contact: its force may take either sign.");
  for (auto& remark : stiff_parts(scene)) list.push_back(std::move(remark));
  if (!scene.dynamics->mesh_cycles)
    list.emplace_back("The periodic motion is found by shooting and confirmed by time integration.");
  return list;
}

/// Responses on changed tables. Those of arc teeth follow from formulas, and only their phases may be too few.
int compared_responses(const Scene& scene) {
  constexpr int fewer_phases = 2;
  if (sun_and_planets(scene).sun_planet.stiffness == StiffnessShape::computed) return comparisons(1);
  return two_k_v(scene).arc_pins.stiffness == StiffnessShape::computed ? fewer_phases : 0;
}

}  // namespace

std::vector<MeshModel> two_k_v_meshes(const Scene& scene) {
  const auto other = compared_scene(scene);
  const Scene& shown = other ? *other : scene;
  return {two_k_v_sun_model(shown), arc_pins_model(shown)};
}

std::vector<PlannedResponse> two_k_v_responses(const Scene& scene) {
  if (!scene.dynamics) return {};
  const auto stage = rough_two_k_v(scene);
  const auto system = assemble(stage);
  // Shooting integrates a period once per state, then twice more; time integration confirms it by two periods, of which
  // the last again with a looser tolerance. Changed tables likewise.
  const double periods = 2.0 * system.dofs() + 2 + 2.6;
  const auto options = two_k_v_simulation(scene, stage);
  const int period =
      std::min(dynamics::times_period(sun_and_planets(scene).planet.teeth, dynamics::period_in_crank_turns(stage)),
               options.max_window_cycles);
  const auto& asked = scene.dynamics->mesh_cycles;
  const auto planned = [&](const std::string& label, const std::string& variant, int compared) {
    using Course = dynamics::StiffnessCourse;
    const double once =
        dynamics::integration_seconds(system, stage.sun_mesh_frequency(), asked ? *asked : periods * period,
                                      options.integrator, compared > 0 ? Course::sudden : Course::smooth);
    constexpr double other = 0.2;         // vibration over a turn of the crank
    constexpr double of_sample = 1.2e-3;  // stiffness, lost motion and modes at one crank angle
    return PlannedResponse{.label = label,
                           .variant = variant,
                           .size = {.work = compared > 0 ? Work::response : Work::response_prescribed,
                                    .unknowns = static_cast<double>(period),
                                    .motion_s = other + once * (1 + compared)},
                           .study_s = variant.empty() ? once : 0,  // studies vary the scene as it is
                           .sample_s = variant.empty() ? of_sample : 0};
  };
  const auto compared = compared_scene(scene);
  std::vector<PlannedResponse> list = {planned("dynamics", "", compared_responses(scene))};
  if (compared) list.push_back(planned("dynamics with computed stiffness", "computed", compared_responses(*compared)));
  return list;
}

void describe_two_k_v(const Scene& scene, Plan& plan) {
  plan.inputs = resolved_inputs(scene, {});
  plan.quantities = two_k_v_quantities(scene, sun_planet_pair(scene));
  if (scene.dynamics) plan.dofs = two_k_v_dofs(scene);
  plan.remarks = two_k_v_remarks(scene, plan.computes());
}

}  // namespace annulus::app
