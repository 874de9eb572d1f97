#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/model/excitation.h"
#include "app/model/stiff_supports.h"
#include "app/plan/gear_geometry.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/helical_pair/pair_space.h"
#include "app/systems/shared/mesh_names.h"
#include "core/units.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus::app {

namespace {

std::vector<Quantity> pair_quantities(const Scene& scene, const PairGeometry& geometry) {
  const auto &pinion = geometry.pinion(), &wheel = geometry.wheel();
  const auto& gears = geometry.gears;
  const double speed = helical_pair(scene).stage.pinion_speed,
               ratio = static_cast<double>(wheel.teeth()) / pinion.teeth();
  return {quantity("ratio", ratio, "wheel teeth / pinion teeth"),
          quantity("centre_distance_mm", gears.centre_distance(), "working centre distance"),
          quantity("transverse_pressure_angle_deg", pinion.transverse_pressure_angle(), "transverse pressure angle"),
          quantity("working_pressure_angle_deg", gears.working_pressure_angle(), "working pressure angle, transverse"),
          quantity("base_helix_angle_deg", geometry.base_helix_angle, "helix angle at the base circle"),
          quantity("transverse_contact_ratio", gears.contact_ratio(), "transverse contact ratio"),
          quantity("overlap_ratio", gears.overlap_ratio(), "overlap ratio"),
          quantity("normal_backlash_um", gears.normal_backlash(), "backlash normal to the flanks"),
          quantity("pinion_base_radius_mm", pinion.base_radius(), "base radius of the pinion"),
          quantity("wheel_base_radius_mm", wheel.base_radius(), "base radius of the wheel"),
          quantity("wheel_speed_rpm", speed / ratio, "speed of the wheel"),
          quantity("wheel_torque_Nm", helical_pair(scene).stage.pinion_torque * ratio, "torque of the wheel"),
          quantity("mesh_frequency_Hz", pinion.teeth() * speed / (2 * std::numbers::pi), "mesh frequency"),
          quantity("transverse_force_N", geometry.transverse_force, "mesh force along the transverse line of action"),
          quantity("normal_force_N", geometry.transverse_force / std::cos(geometry.base_helix_angle),
                   "mesh force along the normal of the flanks"),
          quantity("iso_6336_stiffness_N_per_m", iso_pair_stiffness(scene, geometry),
                   "mean mesh stiffness after ISO 6336-1, along the normal")};
}

std::vector<DofPlan> pair_dofs(const Scene& scene) {
  std::vector<DofPlan> list;
  const double mesh = rough_stiffness(scene, helical_pair(scene).pinion_wheel,
                                      narrower_face(scene, helical_pair(scene).pinion, helical_pair(scene).wheel));
  for (const auto& [name, gear] : {std::pair<std::string, const PairGearInput&>{"pinion", helical_pair(scene).pinion},
                                   {"wheel", helical_pair(scene).wheel}}) {
    const auto add = [&, gear = name](const char* axis, const char* bearing, double stiffness) {
      list.push_back(supported_dof(gear + axis, bearing, stiffness, rigid_if_stiff(stiffness, mesh, scene.accuracy)));
    };
    add(" y", "bearing along the line of action", gear.bearing_transverse);
    add(" z", "axial bearing", gear.bearing_axial);
    list.push_back({name + " u", true, "free to turn: transmits the power"});
  }
  return list;
}

std::vector<std::string> pair_remarks(const Scene& scene, const PairGeometry& geometry, const MeshModel& mesh) {
  std::vector<std::string> list;
  if (mesh.computed())
    list.emplace_back(
        "Only the driving flanks are solved, without friction. The contact is hard (no penetration), and sliding is "
        "small.");
  list.emplace_back(
      "Stiffness, error and backlash of the lumped model act along the normal of the flanks. A stiffness table is for "
      "the transverse section; it is converted with cos² of the base helix angle.");
  if (scene.dynamics) {
    if (!helical_pair(scene).pinion.inertia || !helical_pair(scene).wheel.inertia)
      list.emplace_back("If an inertia is not given, it is that of a solid disc of the given mass.");
    // A gear heavier than its disc has a shaft, a lighter one a web: either makes the disc's inertia a guess.
    for (const auto& [name, gear, input] : {std::tuple{"pinion", &geometry.pinion(), &helical_pair(scene).pinion},
                                            {"wheel", &geometry.wheel(), &helical_pair(scene).wheel}}) {
      const double r = gear->reference_radius();
      const double disc = std::numbers::pi * r * r * face_width_of(scene, *input) * material_of(scene, *input).density;
      if (input->mass && std::abs(*input->mass / disc - 1) > 0.25)
        list.push_back(fmt::format("The {} weighs {} kg, a solid disc of its reference circle and face width {} kg.",
                                   name, to_text(*input->mass, 4), to_text(disc, 3)));
    }
  } else {
    list.emplace_back("No [dynamics]: mesh stiffness and error law only.");
  }
  return list;
}

}  // namespace

dynamics::HelicalPair rough_pair(const Scene& scene, RoughCourse course) {
  const auto& input = helical_pair(scene);
  const auto rough = rough_mesh(scene, input.pinion_wheel, narrower_face(scene, input.pinion, input.wheel), course);
  const auto mesh = excitation_of(rough, unread_table(pinion_wheel), 0, dynamics::LoadDependence::nominal);
  return make_pair(scene, make_pair_geometry(scene), mesh, 0);
}

std::vector<PlannedResponse> pair_responses(const Scene& scene) {
  if (!scene.dynamics) return {};
  // Four motions give the shares at one torque, three the causes at one speed, by harmonic balance.
  double shares = 0;
  if (helical_pair(scene).transmission_error)
    shares = 4.0 * static_cast<double>(helical_pair(scene).transmission_error->pinion_torques.size()) +
             3.0 * static_cast<double>(helical_pair(scene).transmission_error->pinion_speeds.size());
  // Draws of [manufacturing_error]: four numbers of both gears and those that are sorted.
  constexpr double seconds_of_draw = 3.3e-7, MB_of_draw = 9e-5;
  const double draws = helical_pair(scene).manufacturing_error ? helical_pair(scene).manufacturing_error->samples : 0;
  const auto pair = rough_pair(scene);
  const int period = pair.error_period();
  const auto system = assemble(pair);
  const auto options = pair_simulation(scene);
  const bool computed = helical_pair(scene).pinion_wheel.stiffness == StiffnessShape::computed;
  const auto stiffness = computed ? dynamics::StiffnessCourse::sudden : dynamics::StiffnessCourse::smooth;
  auto without_search = options;
  without_search.other_motions.starts = 0;
  const auto course = dynamics::steady_course(system, pair.mesh_frequency(), period, without_search, stiffness);
  const double per_cycle =
      dynamics::integration_seconds(system, pair.mesh_frequency(), 1, options.integrator, stiffness);
  const auto search = dynamics::steady_course(assemble(rough_pair(scene, RoughCourse::rippling)), pair.mesh_frequency(),
                                              period, options, stiffness);
  const double searched_cycles = search.expected_search();
  const double runs = comparisons(computed ? 1 : 0);
  const auto& asked = scene.dynamics->mesh_cycles;
  const bool integrated = course.compared_cycles > 0;
  const double cycles = course.cycles + runs * course.compared_cycles + (asked ? shares * *asked : searched_cycles);
  const double balances = course.balance_s * ((integrated ? 0 : 1 + runs) + (asked ? 0 : shares));
  constexpr double of_study = 1e-3;  // its model, and loss of contact at some points
  const double study_s = of_study + course.balance_s + (asked ? *asked * per_cycle : 0);
  return {{.label = "dynamics of the pair",
           .variant = "",
           .size = {.work = Work::response_prescribed,
                    .unknowns = (1 + shares) * std::min(period, asked.value_or(period)),
                    .motion_s = balances + cycles * per_cycle + draws * seconds_of_draw,
                    .held_MB = draws * MB_of_draw,
                    .tasks = static_cast<int>(1 + shares)},
           .search_s = asked ? 0 : std::max(0.0, search.possible_search_s(per_cycle) - searched_cycles * per_cycle),
           .study_s = study_s,
           .study_search_s = asked ? 0 : searched_cycles * per_cycle,
           .sample_s = study_s}};
}

void describe_pair(const Scene& scene, const PairGeometry& geometry, Plan& plan) {
  std::vector<DerivedInput> derived;
  add_diameters(derived, "pinion", geometry.pinion());
  add_diameters(derived, "wheel", geometry.wheel());
  plan.inputs = resolved_inputs(scene, derived);
  plan.quantities = pair_quantities(scene, geometry);
  if (scene.dynamics) plan.dofs = pair_dofs_in_space(scene, geometry, pair_dofs(scene));
  plan.remarks = pair_remarks(scene, geometry, plan.meshes.front());
}

}  // namespace annulus::app
