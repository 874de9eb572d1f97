#include "app/systems/planetary/planetary_plan.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/model/stiff_supports.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/space_plan.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/units.h"

namespace annulus::app {

namespace {

void add_mesh_quantities(std::vector<Quantity>& list, const std::string& prefix, const geometry::GearPair& pair) {
  const std::string name = pair.internal() ? "ring mesh" : "sun mesh";
  list.push_back(quantity(prefix + "working_pressure_angle_deg", pair.working_pressure_angle(),
                          "working pressure angle of the " + name + ", from the centre distance"));
  list.push_back(quantity(prefix + "contact_ratio", pair.contact_ratio(), "contact ratio of the " + name));
  list.push_back(
      quantity(prefix + "normal_backlash_um", pair.normal_backlash(),
               "backlash of the " + name + " along the line of action, from profile shifts and centre distance"));
}

void add_gear_quantities(std::vector<Quantity>& list, const std::string& body, const geometry::Gear& gear) {
  for (const auto& [circle, radius] :
       {std::pair{"base", gear.base_radius()}, {"tip", gear.tip_radius()}, {"root", gear.root_radius()}})
    list.push_back(quantity(fmt::format("{}_{}_diameter_mm", body, circle), 2 * radius,
                            fmt::format("{} {} diameter", body, circle)));
}

void add_phase_lags(std::vector<Quantity>& list, const geometry::PlanetarySet& set, bool ring) {
  const char* mesh = ring ? "ring" : "sun";
  for (int n = 0; n < set.planets(); ++n)
    list.push_back(quantity(fmt::format("planet{}_{}_phase_lag_cycles", n + 1, mesh),
                            ring ? set.ring_phase_lag(n) : set.sun_phase_lag(n),
                            fmt::format("phase lag of planet {}'s {} mesh", n + 1, mesh)));
}

std::vector<Quantity> stage_quantities(const Scene& scene, const GearGeometry& geometry) {
  const auto& point = geometry.operating_point;
  const auto& set = geometry.rings.front().set;
  std::vector<Quantity> list = {
      quantity("mesh_frequency_Hz", point.mesh_frequency, "mesh frequency"),
      quantity("mean_mesh_force_kN", point.mean_mesh_force,
               fmt::format("mean force of each of the {} meshes, along the line of action", 2 * scene.stage.planets)),
  };
  for (const auto member : stage_members) {
    const auto name = std::string(to_string(member));
    const auto role = role_of(scene, point, member);
    list.push_back(
        quantity(name + "_speed_rpm", point.flow.speed[member], fmt::format("speed of the {}, {}", name, role)));
    list.push_back(quantity(name + "_torque_N_m", point.flow.torque[member], fmt::format("torque on the {}", name)));
  }
  add_gear_quantities(list, "sun", set.sun());
  add_gear_quantities(list, "planet", set.planet());
  add_mesh_quantities(list, "sun_mesh_", geometry.sun_mesh());
  add_phase_lags(list, set, false);
  return list;
}

std::vector<Quantity> ring_quantities(const RingGeometry& ring) {
  std::vector<Quantity> list;
  add_gear_quantities(list, "ring", ring.set.ring());
  list.push_back(quantity("ring_outside_diameter_mm", 2 * ring.outside_radius, "ring outside diameter"));
  list.push_back(quantity("ring_rim_thickness_mm", ring.outside_radius - ring.set.ring().root_radius(),
                          "ring, root circle to outside"));
  add_mesh_quantities(list, "ring_mesh_", ring.set.ring_mesh());
  add_phase_lags(list, ring.set, true);
  return list;
}

std::vector<DofPlan> dofs(const Scene& scene) {
  using geometry::StageMember;
  SupportInput given = supports_with_pins(scene);
  given.sun_torsional = torsional_support(scene, StageMember::sun);
  given.ring_torsional = torsional_support(scene, StageMember::ring);
  given.carrier_torsional = torsional_support(scene, StageMember::carrier);
  // An equilibrium takes every stiffness as it is.
  const auto effective =
      scene.dynamics
          ? effective_supports(
                scene,
                rough_stiffness(scene, sun_and_planets(scene).sun_planet,
                                narrower_face(scene, sun_and_planets(scene).sun, sun_and_planets(scene).planet)),
                rough_stiffness(scene, planetary(scene).ring_planet,
                                narrower_face(scene, sun_and_planets(scene).planet, planetary(scene).rings.front())))
          : given;
  std::vector<DofPlan> list;
  const auto add = [&](const std::string& dof, const char* support, auto SupportInput::*stiffness) {
    const std::optional<double> before = given.*stiffness, after = effective.*stiffness;
    list.push_back(supported_dof(dof, support, *before, *after));
  };
  add("sun x, y", "support", &SupportInput::sun);
  add("sun u", "torsional support", &SupportInput::sun_torsional);
  add("ring x, y", "support", &SupportInput::ring);
  add("ring u", "torsional support", &SupportInput::ring_torsional);
  add("carrier x, y", "support", &SupportInput::carrier);
  add("carrier u", "torsional support", &SupportInput::carrier_torsional);
  const std::string each = fmt::format("planet 1 ... {}", scene.stage.planets);
  if (given.planet_radial.empty() && given.planet_tangential.empty())
    add(each + " x, y", given.planet_clearance > 0 ? "bearing with clearance" : "bearing", &SupportInput::planet);
  else
    for (const auto& [coordinate, direction] :
         {std::pair{"x", &SupportInput::planet_radial}, {"y", &SupportInput::planet_tangential}})
      for (std::size_t n = 0; n < static_cast<std::size_t>(scene.stage.planets); ++n)
        list.push_back(supported_dof(fmt::format("planet {} {}", n + 1, coordinate), "bearing",
                                     given.planet_bearing(direction, n), effective.planet_bearing(direction, n)));
  list.push_back({each + " u", true, "each planet turns on its bearing"});
  return list;
}

void add_single_pin(std::vector<std::string>& list, const RingInput& ring) {
  const auto structure = ring_structure(ring);
  if (structure.single_supports() != 1) return;
  list.push_back(
      fmt::format("Ring '{}' has a single {}, which cannot hold it in equilibrium. Its rim rests in the bore of the "
                  "housing with a radial play of {} µm (housing_clearance_um).",
                  ring.name, structure.words().support, to_text(*ring.housing_clearance / units::um)));
}

/// Pins, bolts and splines along the axis carry no axial force.
void add_axial_force(std::vector<std::string>& list, const Scene& scene, const GearGeometry& geometry,
                     const RingInput& ring) {
  const auto structure = ring_structure(ring);
  if (scene.stage.helix_angle == 0 || !fem::on_single_supports(structure)) return;
  const auto& gear = geometry.rings.front().set.ring();
  const double of_mesh = geometry.operating_point.mean_mesh_force * std::tan(std::abs(gear.base_helix_angle()));
  list.push_back(fmt::format(
      "Each planet presses on ring '{}' with {} kN along the axis. The end face of the ring on that side is taken to "
      "carry this and to keep it from tilting; its {} carry none of it.",
      ring.name, to_text(of_mesh / 1e3, 3), structure.words().supports));
}

std::vector<std::string> remarks(const Scene& scene, const GearGeometry& geometry, bool computed,
                                 bool sun_mesh_computed) {
  std::vector<std::string> list;
  const auto& ring_mesh = geometry.rings.front().set.ring_mesh();
  if (computed) {
    list.push_back(
        fmt::format("Only the driving flanks are solved. The backlash that follows from profile shifts and centre "
                    "distance is {} µm in the sun mesh and {} µm in the ring mesh.",
                    to_text(geometry.sun_mesh().normal_backlash() / units::um, 2),
                    to_text(ring_mesh.normal_backlash() / units::um, 2)));
    list.emplace_back("Friction is neglected. The contact is hard (no penetration), and sliding is small.");
    if (sun_mesh_computed) list.emplace_back("The sun mesh is solved once and shared by all rings.");
    const bool misaligned =
        planetary(scene).errors.sun_planet_misalignment != 0 || planetary(scene).errors.ring_planet_misalignment != 0;
    list.emplace_back(
        misaligned ? "Eccentricities and position errors enter the dynamics; only the misalignments enter the contact "
                     "solution."
                   : "The planet errors of the scene enter the dynamics; the contact solution is without errors.");
    if (sun_and_planets(scene).planet.bore == BoreOn::rollers)
      list.emplace_back(
          "The bore of the planets is the raceway of rollers on a rigid pin. The rollers count as an even bed without "
          "friction: how the rim bends between two of them is left out. Each mesh is solved with the force of the "
          "other one on the planet. The motion that a round rim makes in the bearing is left to the lumped model, in "
          "which the two meshes act on each other through the rim.");
    for (const auto& ring : planetary(scene).rings) {
      add_single_pin(list, ring);
      add_axial_force(list, scene, geometry, ring);
    }
  }
  if (auto remark = remark_on_statics(scene, geometry); !remark.empty()) list.push_back(std::move(remark));
  if (!scene.dynamics) {
    list.emplace_back("No [dynamics]: meshes, transmission error and stiffness only.");
    return list;
  }
  if (geometry.operating_point.mirrored)
    list.emplace_back(
        "The torque of the sun is clockwise. The stage is computed as its mirror image, in which it is "
        "counter-clockwise: directions and drawings of the results are those of the mirror image.");
  if (planetary(scene).supports.planet_clearance > 0)
    list.push_back(
        fmt::format("The planet bearings have {} µm of radial clearance. Their rollers count as many, equal and of "
                    "linear stiffness: the changing stiffness while they pass under the load is left out. The natural "
                    "frequencies are those of small motions about the mean load.",
                    to_text(planetary(scene).supports.planet_clearance / units::um, 4)));
  if (scene.stage.helix_angle != 0 && !moves_in_space(scene))
    list.emplace_back(
        "The lumped model is plane. It contains the transverse forces of helical teeth; their axial forces and tilting "
        "moments are neglected.");
  return list;
}

std::vector<DerivedInput> derived_inputs(const GearGeometry& geometry) {
  const auto& point = geometry.operating_point;
  std::vector<DerivedInput> list = {
      {"stage.power_kW", "", point.power / units::kW, "torque × speed of the member that drives"}};
  for (const auto member : stage_members) {
    const auto name = std::string(to_string(member));
    list.push_back({"stage." + name + "_torque_Nm", "", std::abs(point.flow.torque[member]),
                    "torques of sun, ring and carrier are as z_s : z_r : z_s + z_r"});
    list.push_back({"stage." + name + "_speed_rpm", "", point.flow.speed[member] / units::rpm,
                    "z_s × sun speed + z_r × ring speed = (z_s + z_r) × carrier speed"});
  }
  add_diameters(list, "sun", geometry.rings.front().set.sun());
  add_diameters(list, "planet", geometry.rings.front().set.planet());
  for (const auto& [name, set, outside_radius] : geometry.rings) {
    add_diameters(list, "ring", set.ring(), name);
    list.push_back({"ring.rim_thickness_mm", name, (outside_radius - set.ring().root_radius()) / units::mm,
                    "outside diameter less root diameter, halved"});
    list.push_back({"ring.outside_diameter_mm", name, 2 * outside_radius / units::mm,
                    "root diameter plus twice the rim thickness"});
  }
  return list;
}

}  // namespace

void describe_planetary(const Scene& scene, const GearGeometry& geometry, Plan& plan) {
  plan.inputs = resolved_inputs(scene, derived_inputs(geometry));
  plan.quantities = stage_quantities(scene, geometry);
  for (const auto& ring : geometry.rings) plan.variants.emplace_back(ring.name, ring_quantities(ring));
  if (scene.dynamics || has_statics_in_space(scene)) plan.dofs = dofs_in_space(scene, geometry, dofs(scene));
  if (scene.dynamics) plan.motion = motion_decisions(scene, plan.meshes);
  plan.remarks = remarks(scene, geometry, plan.computes(), plan.meshes.front().computed());
}

}  // namespace annulus::app
