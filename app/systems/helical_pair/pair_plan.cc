#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/model/stiff_supports.h"
#include "app/systems/helical_pair/pair_run.h"
#include "core/units.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus::app {

namespace {

std::vector<Quantity> pair_quantities(const Scene& scene, const PairGeometry& geometry) {
  const auto &pinion = geometry.pinion(), &wheel = geometry.wheel();
  const auto& gears = geometry.gears;
  const double speed = scene.stage.pinion_speed, ratio = static_cast<double>(wheel.teeth()) / pinion.teeth();
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
          quantity("wheel_torque_Nm", scene.stage.pinion_torque * ratio, "torque of the wheel"),
          quantity("mesh_frequency_Hz", pinion.teeth() * speed / (2 * std::numbers::pi), "mesh frequency"),
          quantity("transverse_force_N", geometry.transverse_force, "mesh force along the transverse line of action"),
          quantity("normal_force_N", geometry.transverse_force / std::cos(geometry.base_helix_angle),
                   "mesh force along the normal of the flanks"),
          quantity("iso_6336_stiffness_N_per_m", iso_pair_stiffness(scene, geometry),
                   "mean mesh stiffness after ISO 6336-1, along the normal")};
}

std::vector<DofPlan> pair_dofs(const Scene& scene) {
  std::vector<DofPlan> list;
  const double mesh = rough_stiffness(scene, scene.pinion_wheel);
  for (const auto& [name, gear] :
       {std::pair<std::string, const PairGearInput&>{"pinion", scene.pinion}, {"wheel", scene.wheel}}) {
    const auto add = [&, gear = name](const char* axis, const char* bearing, double stiffness) {
      list.push_back(supported_dof(gear + axis, bearing, stiffness, rigid_if_stiff(stiffness, mesh, scene.accuracy)));
    };
    add(" y", "bearing along the line of action", gear.bearing_transverse);
    add(" z", "axial bearing", gear.bearing_axial);
    list.push_back({name + " u", true, "free to turn: carries the power"});
  }
  return list;
}

std::vector<std::string> pair_remarks(const Scene& scene, const PairGeometry& geometry, const MeshModel& mesh) {
  std::vector<std::string> list;
  if (mesh.computed())
    list.emplace_back(
        "Only the driving flanks are solved, without friction; the contact is hard and the sliding small.");
  list.emplace_back(
      "Stiffness, error and backlash of the lumped model act along the normal of the flanks; a stiffness table holds "
      "the transverse section and is turned by cos² of the base helix angle.");
  if (scene.dynamics) {
    remark_backlash(list, scene.pinion_wheel.half_backlash.value_or(scene.dynamics->half_backlash), geometry.gears);
    if (!scene.pinion.inertia || !scene.wheel.inertia)
      list.emplace_back("Inertias that are not given are those of solid discs of the given mass.");
    // A gear heavier than its disc has a shaft, a lighter one a web: either makes the disc's inertia a guess.
    for (const auto& [name, gear, input] :
         {std::tuple{"pinion", &geometry.pinion(), &scene.pinion}, {"wheel", &geometry.wheel(), &scene.wheel}}) {
      const double r = gear->reference_radius();
      const double disc = std::numbers::pi * r * r * scene.stage.face_width * scene.material.density;
      if (input->mass && std::abs(*input->mass / disc - 1) > 0.25)
        list.push_back(fmt::format("The {} weighs {} kg, a solid disc of its reference circle and face width {} kg.",
                                   name, to_text(*input->mass, 4), to_text(disc, 3)));
    }
  } else {
    list.emplace_back("No [dynamics]: mesh stiffness and error law only.");
  }
  return list;
}

/// Time integration of one response: of `mesh_cycles`, else of the window that confirms it.
double pair_integration_seconds(const Scene& scene) {
  const auto& given = scene.pinion_wheel;
  dynamics::MeshExcitation mesh = dynamics::ConstantStiffness{rough_stiffness(scene, given)};
  if (given.stiffness == StiffnessShape::rectangular)
    mesh = dynamics::RectangularStiffness{*given.mean, *given.ripple, *given.duty, 0};
  const auto pair = make_pair(scene, make_pair_geometry(scene), mesh, 0);
  const auto options = pair_simulation(scene);
  const int cycles = scene.dynamics->mesh_cycles.value_or(
      std::min(std::max(pair.error_period(), options.min_window_cycles), options.max_window_cycles));
  return dynamics::integration_seconds(assemble(pair), pair.mesh_frequency(), cycles, options.integrator);
}

}  // namespace

std::vector<PlannedResponse> pair_responses(const Scene& scene) {
  if (!scene.dynamics) return {};
  // Four motions give the shares at one torque, three the causes at one speed.
  double responses = 1;
  if (scene.transmission_error)
    responses += 4.0 * static_cast<double>(scene.transmission_error->pinion_torques.size()) +
                 3.0 * static_cast<double>(scene.transmission_error->pinion_speeds.size());
  // An error of the pinion or the wheel passes once a turn.
  const bool turns = scene.errors.pinion_error != 0 || scene.errors.wheel_error != 0;
  const int period = turns ? std::lcm(scene.pinion.teeth, scene.wheel.teeth) : 1;
  const auto& asked = scene.dynamics->mesh_cycles;
  const double once = pair_integration_seconds(scene);
  // Of all responses, only the first one is confirmed by time integration. Studies take 4 ms at the ends of a torque
  // and speed grid, some tens where contact is lost; a wave once per turn makes the window longer.
  return {{.label = "dynamics of the pair",
           .ring = "",
           .size = {.work = Work::response_pair,
                    .unknowns = responses * std::min(period, asked.value_or(period)),
                    .integration_s = (asked ? responses : 1) * once,
                    .tasks = static_cast<int>(responses)},
           .study_s = (turns ? 0.5 : 0.02) + (asked ? once : 0)}};
}

void describe_pair(const Scene& scene, const PairGeometry& geometry, Plan& plan) {
  std::vector<DerivedInput> derived;
  add_diameters(derived, "pinion", geometry.pinion());
  add_diameters(derived, "wheel", geometry.wheel());
  plan.inputs = resolved_inputs(scene, derived);
  plan.quantities = pair_quantities(scene, geometry);
  if (scene.dynamics) plan.dofs = pair_dofs(scene);
  plan.remarks = pair_remarks(scene, geometry, plan.meshes.front());
}

}  // namespace annulus::app
