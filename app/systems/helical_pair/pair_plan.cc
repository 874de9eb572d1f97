#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/model/stiff_supports.h"
#include "app/plan/cost_plan.h"
#include "app/systems/helical_pair/pair_run.h"
#include "core/units.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus::app {

namespace {

std::vector<Quantity> pair_quantities(const Scene& scene, const PairGeometry& geometry) {
  const auto &pinion = geometry.pinion(), &wheel = geometry.wheel();
  const auto& gears = geometry.gears;
  const double speed = scene.stage.pinion_speed, ratio = static_cast<double>(wheel.teeth()) / pinion.teeth();
  return {{"ratio", ratio, "", "wheel teeth / pinion teeth"},
          {"centre_distance_mm", gears.centre_distance() / units::mm, "mm", "working centre distance"},
          {"transverse_pressure_angle_deg", pinion.transverse_pressure_angle() / units::deg, "°",
           "transverse pressure angle"},
          {"working_pressure_angle_deg", gears.working_pressure_angle() / units::deg, "°",
           "working pressure angle, transverse"},
          {"base_helix_angle_deg", geometry.base_helix_angle / units::deg, "°", "helix angle at the base circle"},
          {"transverse_contact_ratio", gears.contact_ratio(), "", "transverse contact ratio"},
          {"overlap_ratio", gears.overlap_ratio(), "", "overlap ratio"},
          {"normal_backlash_um", gears.normal_backlash() / units::um, "µm", "backlash normal to the flanks"},
          {"pinion_base_radius_mm", pinion.base_radius() / units::mm, "mm", "base radius of the pinion"},
          {"wheel_base_radius_mm", wheel.base_radius() / units::mm, "mm", "base radius of the wheel"},
          {"wheel_speed_rpm", speed / ratio / units::rpm, "r/min", "speed of the wheel"},
          {"wheel_torque_Nm", scene.stage.pinion_torque * ratio, "N m", "torque of the wheel"},
          {"mesh_frequency_Hz", pinion.teeth() * speed / (2 * std::numbers::pi), "Hz", "mesh frequency"},
          {"transverse_force_N", geometry.transverse_force, "N", "mesh force along the transverse line of action"},
          {"normal_force_N", geometry.transverse_force / std::cos(geometry.base_helix_angle), "N",
           "mesh force along the normal of the flanks"},
          {"iso_6336_stiffness_N_per_m", iso_pair_stiffness(scene, geometry), "N/m",
           "mean mesh stiffness after ISO 6336-1, along the normal"}};
}

std::vector<DofPlan> pair_dofs(const Scene& scene) {
  std::vector<DofPlan> list;
  for (const auto& [name, gear] : {std::pair{"pinion", &scene.pinion}, {"wheel", &scene.wheel}}) {
    const std::string of = name;
    const auto bearing = [&](const char* axis, double stiffness, const char* what) {
      const bool kept =
          std::isfinite(rigid_if_stiff(stiffness, rough_stiffness(scene, scene.pinion_wheel), scene.accuracy));
      list.push_back({of + " " + axis, kept,
                      kept || std::isfinite(stiffness) ? fmt::format("{} of {} N/m{}", what, to_text(stiffness),
                                                                     kept ? "" : ": rigid beside the mesh, dropped")
                                                       : "rigid bearing: dropped"});
    };
    bearing("y", gear->bearing_transverse, "bearing along the line of action");
    bearing("z", gear->bearing_axial, "axial bearing");
    list.push_back({of + " u", true, "free to turn: carries the power"});
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
    const double half = geometry.gears.normal_backlash() / 2;
    const double used = scene.pinion_wheel.half_backlash.value_or(scene.dynamics->half_backlash);
    if (used > half + 1 * units::um)
      list.push_back(fmt::format("The dynamics uses the given half backlash of {} µm; the geometry leaves {} µm.",
                                 to_text(used / units::um, 4), to_text(std::round(1e3 * half / units::um) / 1e3, 3)));
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

std::vector<Input> pair_inputs(const Scene& scene, const PairGeometry& geometry) {
  std::vector<Input> list;
  for (const auto& input : scene.inputs) {
    if (!std::holds_alternative<std::monostate>(input.value)) {
      list.push_back(input);
      continue;
    }
    const geometry::Gear* gear = input.key.starts_with("pinion.")  ? &geometry.pinion()
                                 : input.key.starts_with("wheel.") ? &geometry.wheel()
                                                                   : nullptr;
    if (!gear) continue;
    Input derived = input;
    derived.origin = Origin::derived;
    if (input.key.ends_with(".tip_diameter_mm")) {
      derived.value = 2 * gear->tip_radius() / units::mm;
    } else if (input.key.ends_with(".root_diameter_mm")) {
      derived.value = 2 * gear->root_radius() / units::mm;
    } else {
      continue;
    }
    list.push_back(derived);
  }
  return list;
}

}  // namespace

std::vector<PlannedResponse> pair_responses(const Scene& scene, int threads) {
  if (!scene.dynamics) return {};
  CostRun size;
  size.kind = "response_pair";
  size.threads = threads;
  // Four motions tell the shares at one torque, three the causes at one speed.
  double responses = 1;
  if (scene.transmission_error)
    responses += 4.0 * static_cast<double>(scene.transmission_error->pinion_torques.size()) +
                 3.0 * static_cast<double>(scene.transmission_error->pinion_speeds.size());
  // An error of the pinion or the wheel passes once a turn.
  const bool turns = scene.errors.pinion_error != 0 || scene.errors.wheel_error != 0;
  const int period = turns ? std::lcm(scene.pinion.teeth, scene.wheel.teeth) : 1;
  size.unknowns = responses * std::min(period, scene.dynamics->mesh_cycles.value_or(period));
  return {{"dynamics of the pair", "", size, responses * pair_integration_seconds(scene)}};
}

double pair_integration_seconds(const Scene& scene) {
  const auto geometry = make_pair_geometry(scene);
  const auto& given = scene.pinion_wheel;
  dynamics::MeshExcitation mesh = dynamics::ConstantStiffness{rough_stiffness(scene, given)};
  if (given.stiffness == StiffnessShape::rectangular)
    mesh = dynamics::RectangularStiffness{*given.mean, *given.ripple, *given.duty, 0};
  const auto pair = make_pair(scene, geometry, mesh, 0);
  const auto options = pair_simulation(scene);
  const int cycles = scene.dynamics->mesh_cycles.value_or(
      std::min(std::max(pair.error_period(), options.min_window_cycles), options.max_window_cycles));
  return dynamics::integration_seconds(assemble(pair), pair.mesh_frequency(), cycles, options.integrator);
}

void describe_pair(const Scene& scene, const PairGeometry& geometry, Plan& plan) {
  plan.inputs = pair_inputs(scene, geometry);
  plan.quantities = pair_quantities(scene, geometry);
  if (scene.dynamics) plan.dofs = pair_dofs(scene);
  plan.remarks = pair_remarks(scene, geometry, plan.meshes.front());
}

}  // namespace annulus::app
