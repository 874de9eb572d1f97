#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "app/scene/model_limits.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/tolerance_sharing.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/units.h"
#include "fem/problem/problem_check.h"

namespace annulus::app {

namespace {

void check_ring_rim(const Scene& scene, const RingInput& input, const RingGeometry& ring) {
  const auto refuse = [&](const char* key, double value, const std::string& rule) {
    throw GeometryError(fmt::format("ring '{}': {} = {}: {}", input.name, key, to_text(value / units::mm), rule));
  };
  const double root = ring.set.ring().root_radius(), rim = ring.outside_radius - root, least = least_rim(scene);
  if (rim < least * (1 - diameter_rounding)) {
    if (input.rim_thickness)
      refuse("rim_thickness_mm", *input.rim_thickness,
             fmt::format("must be at least {}; {}", length_mm(least), rim_rule(scene)));
    refuse("outside_diameter_mm", 2 * ring.outside_radius,
           fmt::format("must be at least {}; {}", length_mm(2 * (root + least)), rim_rule(scene)));
  }
  check_structure_in_rim(scene, input, ring);
}

void check_ring_supports(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto problem = ring_mesh_problem(scene, geometry, ring);
  if (!problem || !fem::on_single_supports(problem->structure)) return;
  const double turn = fem::turn_on_supports(*problem, geometry.operating_point.mean_mesh_force);
  const double modules = turn / scene.stage.module;
  if (modules <= largest_deflection) return;
  throw InputError(
      fmt::format("ring '{}': turns on its {} by {} mm = {:.2g} modules under the nominal load; {}: make them stiffer, "
                  "use more of them, or reduce their clearance",
                  planetary(scene).rings.at(ring).name, problem->structure.words().supports,
                  to_text(turn / units::mm, 3), modules, small_displacements_rule()));
}

/// Least load of the bearing of a central body, in mean mesh forces: planets on one side of it cannot keep it centred.
/// Forces that add up to one per planet, in directions fixed to the planets, have the smallest resultant when the
/// outermost two share them.
double least_bearing_load(const geometry::PlanetarySet& set) {
  std::vector<double> angles;
  angles.reserve(static_cast<std::size_t>(set.planets()));
  for (int n = 0; n < set.planets(); ++n) angles.push_back(set.planet_angle(n));
  std::sort(angles.begin(), angles.end());
  double widest_gap = 2 * std::numbers::pi - angles.back();
  for (std::size_t n = 1; n < angles.size(); ++n) widest_gap = std::max(widest_gap, angles[n] - angles[n - 1]);
  return set.planets() * std::max(0.0, -std::cos(widest_gap / 2));
}

/// m, of the middle of the face on which two gears touch, along the axis.
double middle_of_face(const geometry::GearPair& pair) {
  const auto& p = pair.pinion().parameters();
  const auto face = pair.common_face();
  return p.axial_offset - p.face_width / 2 + face.pinion.below + face.width / 2;
}

/// Along helical teeth the mesh phase changes: both meshes of a planet are taken at one place of the axis.
void check_helical_faces(const Scene& scene, const GearGeometry& geometry) {
  if (scene.stage.helix_angle == 0) return;
  for (const auto& ring : geometry.rings) {
    const double apart = middle_of_face(ring.set.ring_mesh()) - middle_of_face(ring.set.sun_mesh());
    if (std::abs(apart) <= 1e-6 * scene.stage.face_width) continue;
    throw GeometryError(fmt::format(
        "ring '{}': the middles of the faces on which the planets touch the ring and the sun are {} mm apart along the "
        "axis. With helical teeth this changes the phase between both meshes, which is not modelled: change "
        "face_width_mm "
        "or axial_offset_mm so that they agree, or use spur teeth",
        ring.name, to_text(apart / units::mm, 4)));
  }
}

/// The pin of each planet by itself.
void check_pin(const Scene& scene, double force) {
  const auto& s = planetary(scene).supports;
  if (s.planet_pin == PinMounting::unbending) return;
  const double diameter = *s.pin_diameter;
  if (sun_and_planets(scene).planet.bore_diameter && diameter >= *sun_and_planets(scene).planet.bore_diameter)
    throw InputError(fmt::format("supports.planet_pin_diameter_mm = {}: does not fit into the planet's bore of {} mm",
                                 to_text(diameter / units::mm, 6),
                                 to_text(*sun_and_planets(scene).planet.bore_diameter / units::mm, 6)));
  const double deflection = force / pin_stiffness(scene), limit = displacement_limit(scene);
  if (deflection <= limit) return;
  throw InputError(fmt::format(
      "supports.planet_pin_diameter_mm = {}: a pin of this diameter and {} mm length deflects under the load "
      "of {} N by {} mm; at most {} mm is possible, {} of the module: use a thicker or a shorter pin",
      to_text(diameter / units::mm, 6), to_text(*s.pin_length / units::mm, 6), to_text(force, 3),
      to_text(deflection / units::mm, 3), to_text(limit / units::mm, 3), largest_gear_displacement));
}

/// The play of planet bearings, and that more than a roller carries.
void check_clearance(const Scene& scene, double force) {
  const auto& s = planetary(scene).supports;
  if (s.planet_clearance == 0) return;
  const auto shown = fmt::format("supports.planet_clearance_um = {}", to_text(s.planet_clearance / units::um, 6));
  const double limit = displacement_limit(scene);
  if (s.planet_clearance / 2 > limit)
    throw InputError(
        fmt::format("{}: half of it moves a planet by more than {} of the module: at most {} µm is possible", shown,
                    largest_gear_displacement, to_text(2 * limit / units::um, 4)));
  // The bed of a planet on rollers has patches of some degrees, and its table has loads below this one.
  const bool bed = sun_and_planets(scene).planet.bore == BoreOn::rollers;
  const double least = (bed ? 45 : 10) * units::deg, zone = bearing_law(scene).load_zone(force);
  if (zone >= least) return;
  throw InputError(fmt::format(
      "{}: under {} N the rollers of a bearing of {} N/m carry over {:.2g} degrees; the law of a bearing of "
      "many rollers needs {:.2g} degrees{}: reduce the clearance or supports.planet_N_per_m, or raise the load",
      shown, to_text(force, 3), to_text(s.planet, 4), zone / units::deg, least / units::deg,
      bed ? " where the bore of the planets is the raceway (planet.bore)" : ""));
}

/// The sun mesh is solved once, with the ring mesh of the first ring as the other mesh of its planets.
void check_rings_of_planets_on_rollers(const Scene& scene, const GearGeometry& geometry) {
  if (sun_and_planets(scene).planet.bore != BoreOn::rollers) return;
  const auto& first = geometry.rings.front();
  for (const auto& ring : geometry.rings) {
    const double angle = ring.set.ring_mesh().working_pressure_angle(),
                 of_first = first.set.ring_mesh().working_pressure_angle();
    if (std::abs(angle - of_first) <= 1e-9) continue;
    throw InputError(fmt::format(
        "planet.bore = rollers: the sun mesh is solved once for all rings, with the force of the ring mesh on "
        "the planet; the rings '{}' and '{}' have working pressure angles of {:.6g} and {:.6g} degrees: use a "
        "scene for each",
        first.name, ring.name, of_first / units::deg, angle / units::deg));
  }
}

void check_planetary_bearings(const Scene& scene, const GearGeometry& geometry) {
  const auto& s = planetary(scene).supports;
  const double pin_force =
      geometry.operating_point.mean_mesh_force * pin_force_per_mesh_force(geometry.rings.front().set);
  check_pin(scene, pin_force);
  check_clearance(scene, pin_force);
  const double mesh = geometry.operating_point.mean_mesh_force;
  check_bearing(scene, "supports.planet_N_per_m", s.planet, 2 * mesh);
  for (const auto& [key, bearings] : {std::pair{"supports.planet_radial_N_per_m", &s.planet_radial},
                                      {"supports.planet_tangential_N_per_m", &s.planet_tangential}})
    for (const double bearing : *bearings) check_bearing(scene, key, bearing, 2 * mesh);
  const double across = mesh * least_bearing_load(geometry.rings.front().set);
  check_bearing(scene, "supports.sun_N_per_m", s.sun, across);
  check_bearing(scene, "supports.ring_N_per_m", s.ring, across);
  check_bearing(scene, "supports.carrier_N_per_m", s.carrier, 2 * across);
  const double all = scene.stage.planets * mesh;
  const auto& set = geometry.rings.front().set;
  using geometry::StageMember;
  for (const auto& [member, key, force, radius] :
       {std::tuple{StageMember::sun, "supports.sun_torsional_N_per_m", all, set.sun().base_radius()},
        {StageMember::carrier, "supports.carrier_torsional_N_per_m", 2 * all, set.centre_distance()},
        {StageMember::ring, "supports.ring_torsional_N_per_m", all, set.ring().base_radius()}})
    if (const double support = torsional_support(scene, member); support > 0)
      check_torsional_support(key, support, force, radius);
}

}  // namespace

void check_planetary_geometry(const Scene& scene, const GearGeometry& geometry) {
  const bool sun = sun_and_planets(scene).sun_planet.stiffness == StiffnessShape::computed;
  const bool ring = planetary(scene).ring_planet.stiffness == StiffnessShape::computed;
  if (sun) check_bore(scene, "sun", sun_and_planets(scene).sun, geometry.sun_mesh().wheel());
  if (sun || ring) check_bore(scene, "planet", sun_and_planets(scene).planet, geometry.sun_mesh().pinion());
  check_rings_of_planets_on_rollers(scene, geometry);
  for (std::size_t i = 0; ring && i < planetary(scene).rings.size(); ++i)
    check_ring_rim(scene, planetary(scene).rings[i], geometry.rings.at(i));

  const char* load = planetary(scene).stage.power            ? "stage.power_kW"
                     : planetary(scene).stage.sun_torque     ? "stage.sun_torque_Nm"
                     : planetary(scene).stage.carrier_torque ? "stage.carrier_torque_Nm"
                                                             : "stage.ring_torque_Nm";
  const double mesh_force = geometry.operating_point.mean_mesh_force;
  if (scene.dynamics) {
    check_deviations(scene);
    check_helical_faces(scene, geometry);
    check_planetary_bearings(scene, geometry);
    for (const auto* mesh : {&sun_and_planets(scene).sun_planet, &planetary(scene).ring_planet})
      check_prescribed_mesh(scene, load, *mesh, mesh_force);
  }
  for (std::size_t i = 0; planetary(scene).tolerances && i < planetary(scene).rings.size(); ++i)
    (void)stage_tolerances(scene, geometry, i);
  const auto planet = material_of(scene, sun_and_planets(scene).planet);
  const auto check_mesh = [&](const GearInput& wheel, const geometry::GearPair& pair) {
    check_load(scene, load, mesh_force, pair.common_face().width,
               fem::MeshMaterials(planet, material_of(scene, wheel)).youngs_modulus());
  };
  if (sun) check_mesh(sun_and_planets(scene).sun, geometry.sun_mesh());
  for (std::size_t i = 0; ring && i < planetary(scene).rings.size(); ++i)
    check_mesh(planetary(scene).rings[i], geometry.rings.at(i).set.ring_mesh());
  for (std::size_t i = 0; i < planetary(scene).rings.size(); ++i) check_ring_supports(scene, geometry, i);
}

std::vector<std::string> planetary_faults(const Scene& scene) {
  std::vector<std::string> faults;
  const auto attempt = [&](const auto& check) {
    try {
      check();
    } catch (const Error& error) {
      if (std::find(faults.begin(), faults.end(), error.what()) == faults.end()) faults.emplace_back(error.what());
    }
  };
  using geometry::GearKind;
  const auto gear = [&](const std::string& name, const GearInput& input, GearKind kind) {
    attempt([&] { (void)geometry_of(name, [&] { return make_gear(scene, input, kind); }); });
  };
  gear("sun", sun_and_planets(scene).sun, GearKind::external);
  gear("planet", sun_and_planets(scene).planet, GearKind::external);
  for (const auto& ring : planetary(scene).rings) gear("ring '" + ring.name + "'", ring, GearKind::internal);
  if (!faults.empty()) return faults;  // pairs of gears that cannot exist say nothing new
  for (const auto& ring : planetary(scene).rings) {
    Scene alone = scene;
    planetary(alone).rings = {ring};
    attempt([&] { check_planetary_geometry(alone, make_geometry(alone)); });
  }
  return faults;
}

}  // namespace annulus::app
