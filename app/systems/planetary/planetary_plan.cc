#include "app/systems/planetary/planetary_plan.h"

#include <fmt/format.h>

#include <cmath>

#include "app/model/stiff_supports.h"
#include "app/plan/cost_plan.h"
#include "app/systems/planetary/motion_plan.h"
#include "app/systems/planetary/ring_structures.h"
#include "core/units.h"

namespace annulus::app {

namespace {

void add_mesh_quantities(std::vector<Quantity>& list, const std::string& prefix, const geometry::GearPair& pair) {
  const bool ring = pair.internal();
  const std::string name = ring ? "ring mesh" : "sun mesh";
  list.push_back({prefix + "working_pressure_angle_deg", pair.working_pressure_angle() / units::deg, "°",
                  "working pressure angle of the " + name + ", from the centre distance"});
  list.push_back({prefix + "contact_ratio", pair.contact_ratio(), "", "contact ratio of the " + name});
  list.push_back({prefix + "normal_backlash_um", pair.normal_backlash() / units::um, "µm",
                  "backlash of the " + name + " along the line of action, from profile shifts and centre distance"});
}

void add_gear_quantities(std::vector<Quantity>& list, const std::string& body, const geometry::Gear& gear) {
  const auto diameter = [&](const std::string& which, double radius) {
    list.push_back(
        {body + "_" + which + "_diameter_mm", 2 * radius / units::mm, "mm", body + " " + which + " diameter"});
  };
  diameter("base", gear.base_radius());
  diameter("tip", gear.tip_radius());
  diameter("root", gear.root_radius());
}

std::vector<Quantity> stage_quantities(const Scene& scene, const GearGeometry& geometry) {
  const auto& point = geometry.operating_point;
  const auto& set = geometry.rings.front().set;
  std::vector<Quantity> list = {
      {"sun_speed_rpm", point.sun_speed / units::rpm, "r/min", "speed of the sun"},
      {"carrier_speed_rpm", point.carrier_speed / units::rpm, "r/min", "speed of the carrier, ring fixed"},
      {"sun_torque_N_m", point.sun_torque, "N m", "torque of the sun, power over speed"},
      {"carrier_torque_N_m", point.carrier_torque, "N m", "torque of the carrier"},
      {"mesh_frequency_Hz", point.mesh_frequency, "Hz", "mesh frequency"},
      {"mean_mesh_force_kN", point.mean_mesh_force / 1e3, "kN",
       fmt::format("mean force of each of the {} meshes, along the line of action", 2 * scene.stage.planets)},
  };
  add_gear_quantities(list, "sun", set.sun());
  add_gear_quantities(list, "planet", set.planet());
  add_mesh_quantities(list, "sun_mesh_", geometry.sun_mesh());
  for (int n = 0; n < set.planets(); ++n) {
    list.push_back({fmt::format("planet{}_sun_phase_lag_cycles", n + 1), set.sun_phase_lag(n), "mesh cycles",
                    fmt::format("phase lag of planet {}'s sun mesh", n + 1)});
  }
  return list;
}

std::vector<Quantity> ring_quantities(const RingGeometry& ring) {
  std::vector<Quantity> list;
  add_gear_quantities(list, "ring", ring.set.ring());
  list.push_back({"ring_outside_diameter_mm", 2 * ring.outside_radius / units::mm, "mm", "ring outside diameter"});
  list.push_back({"ring_rim_thickness_mm", (ring.outside_radius - ring.set.ring().root_radius()) / units::mm, "mm",
                  "ring, root circle to outside"});
  add_mesh_quantities(list, "ring_mesh_", ring.set.ring_mesh());
  for (int n = 0; n < ring.set.planets(); ++n) {
    list.push_back({fmt::format("planet{}_ring_phase_lag_cycles", n + 1), ring.set.ring_phase_lag(n), "mesh cycles",
                    fmt::format("phase lag of planet {}'s ring mesh", n + 1)});
  }
  return list;
}

/// Why a support leaves no DOF.
std::string rigid_text(double given, const char* what) {
  return std::isfinite(given) ? fmt::format("{} of {} N/m gives way by less than a thousandth of the accuracy: dropped",
                                            what, to_text(given))
                              : fmt::format("rigid {}: dropped", what);
}

std::vector<DofPlan> dofs(const Scene& scene) {
  const SupportInput& given = scene.supports;
  const int planets = scene.stage.planets;
  const auto supports =
      effective_supports(scene, rough_stiffness(scene, scene.sun_planet), rough_stiffness(scene, scene.ring_planet));
  std::vector<DofPlan> list;
  const auto plane = [&](const std::string& name, double SupportInput::*member) {
    const bool kept = std::isfinite(supports.*member);
    list.push_back(
        {name + " x, y", kept,
         kept ? fmt::format("support of {} N/m", to_text(supports.*member)) : rigid_text(given.*member, "support")});
  };
  const auto turn = [&](const std::string& name, double stiffness) {
    const bool kept = std::isfinite(stiffness);
    list.push_back({name + " u", kept,
                    !kept            ? "fixed against rotation: dropped"
                    : stiffness == 0 ? "free to turn: carries the power"
                                     : fmt::format("torsional support of {} N/m", to_text(stiffness))});
  };
  plane("sun", &SupportInput::sun);
  turn("sun", supports.sun_torsional);
  plane("ring", &SupportInput::ring);
  turn("ring", supports.ring_torsional);
  plane("carrier", &SupportInput::carrier);
  turn("carrier", supports.carrier_torsional);
  const std::string each = fmt::format("planet 1 ... {}", planets);
  plane(each, &SupportInput::planet);
  if (!std::isfinite(supports.planet))
    list.back().reason = rigid_text(given.planet, "bearings") + ", the planets ride on the carrier";
  list.push_back({each + " u", true, "each planet turns on its bearing"});
  return list;
}

void add_single_pin(std::vector<std::string>& list, const RingInput& ring) {
  const auto structure = ring_structure(ring);
  if (structure.single_supports() != 1) return;
  list.push_back(fmt::format(
      "Ring '{}' has a single {}, which cannot hold it in equilibrium: its rim rests in the bore of the housing, with "
      "a radial play of {} µm (housing_clearance_um).",
      ring.name, structure.words().support, to_text(*ring.housing_clearance / units::um)));
}

std::vector<std::string> remarks(const Scene& scene, const GearGeometry& geometry,
                                 const std::vector<MeshModel>& meshes) {
  std::vector<std::string> list;
  bool computed = false;
  for (const auto& mesh : meshes) computed = computed || mesh.computed();
  if (computed) {
    list.push_back(
        fmt::format("Only the driving flanks are solved. The backlash that follows from profile shifts and centre "
                    "distance is {} µm in the sun mesh "
                    "and {} µm in the ring mesh; where it is smaller than the deflection, the back flanks would touch "
                    "as well, which is left out.",
                    to_text(geometry.sun_mesh().normal_backlash() / units::um, 2),
                    to_text(geometry.rings.front().set.ring_mesh().normal_backlash() / units::um, 2)));
    list.emplace_back("Friction is left out; the contact is hard and the sliding small.");
    if (meshes.front().computed()) list.emplace_back("The sun mesh is solved once and shared by all rings.");
    const bool misaligned = scene.errors.sun_planet_misalignment != 0 || scene.errors.ring_planet_misalignment != 0;
    list.emplace_back(misaligned
                          ? "Eccentricities and position errors enter the dynamics; of all errors only the "
                            "misalignments enter the contact solve."
                          : "The planet errors of the scene enter the dynamics; the contact solve itself is free of "
                            "errors.");
    if (scene.fidelity == Fidelity::closed_form) {
      list.emplace_back(
          "The error of the closed-form stiffness is not controlled: the wanted accuracy is not checked.");
    }
    for (const auto& ring : scene.rings) add_single_pin(list, ring);
  }
  if (scene.dynamics && scene.stage.helix_angle != 0)
    list.emplace_back(
        "The lumped model is plane: it has the transverse forces of helical teeth, their axial forces and tilting "
        "moments "
        "are left out.");
  if (scene.dynamics) {
    const double half = geometry.rings.front().set.ring_mesh().normal_backlash() / 2;
    if (scene.dynamics->half_backlash > half + 1 * units::um) {
      list.push_back(
          fmt::format("The dynamics uses the given half backlash of {} µm; the geometry leaves {} µm in the ring mesh.",
                      to_text(scene.dynamics->half_backlash / units::um, 4), to_text(half / units::um, 2)));
    }
  } else {
    list.emplace_back("No [dynamics]: meshes, transmission error and stiffness only.");
  }
  return list;
}

std::vector<Input> resolved_inputs(const Scene& scene, const GearGeometry& geometry) {
  std::vector<Input> list;
  const auto derive = [](Input input, double value, std::string how) {
    input.value = value;
    input.origin = Origin::derived;
    input.note = std::move(how);
    return input;
  };
  const auto& point = geometry.operating_point;
  const auto& first = geometry.rings.front().set;
  for (const auto& input : scene.inputs) {
    const geometry::Gear* gear = input.key.starts_with("sun.")      ? &first.sun()
                                 : input.key.starts_with("planet.") ? &first.planet()
                                                                    : nullptr;
    const RingGeometry* ring = nullptr;
    for (const auto& candidate : geometry.rings) {
      if (candidate.name == input.ring && input.key.starts_with("ring.")) ring = &candidate;
    }
    if (ring) gear = &ring->set.ring();
    if (!std::holds_alternative<std::monostate>(input.value)) {
      list.push_back(input);
    } else if (input.key == "stage.carrier_speed_rpm") {
      list.push_back(derive(input, point.carrier_speed / units::rpm, "sun speed / (1 + z_r / z_s)"));
    } else if (input.key == "stage.sun_speed_rpm") {
      list.push_back(derive(input, point.sun_speed / units::rpm, "carrier speed × (1 + z_r / z_s)"));
    } else if (gear && input.key.ends_with(".tip_diameter_mm")) {
      list.push_back(derive(input, 2 * gear->tip_radius() / units::mm, input.note));
    } else if (gear && input.key.ends_with(".root_diameter_mm")) {
      list.push_back(derive(input, 2 * gear->root_radius() / units::mm, input.note));
    } else if (ring && input.key == "ring.rim_thickness_mm") {
      list.push_back(derive(input, (ring->outside_radius - gear->root_radius()) / units::mm,
                            "outside diameter less root diameter, halved"));
    } else if (ring && input.key == "ring.outside_diameter_mm") {
      list.push_back(derive(input, 2 * ring->outside_radius / units::mm, "root diameter plus twice the rim thickness"));
    }
  }
  return list;
}

}  // namespace

void describe_planetary(const Scene& scene, const GearGeometry& geometry, Plan& plan) {
  plan.inputs = resolved_inputs(scene, geometry);
  plan.quantities = stage_quantities(scene, geometry);
  for (const auto& ring : geometry.rings) plan.rings.emplace_back(ring.name, ring_quantities(ring));
  if (scene.dynamics) {
    plan.dofs = dofs(scene);
    plan.motion = motion_decisions(scene, plan.meshes);
  }
  plan.remarks = remarks(scene, geometry, plan.meshes);
}

}  // namespace annulus::app
