#include <algorithm>
#include <cmath>
#include <utility>

#include "app/model/excitation.h"
#include "app/results/cached_value.h"
#include "app/systems/planetary/pitch_deviations.h"
#include "app/systems/planetary/planet_coupling.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/stage_members.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

dynamics::BodyErrors deviations_of(const BodyErrorInput& e) {
  return {{e.eccentricity, e.eccentricity_phase}, {e.position, e.position_phase}};
}

}  // namespace

MeshInput in_transverse_section(const MeshInput& mesh, const geometry::GearPair& pair) {
  MeshInput result = mesh;
  if (result.mean) *result.mean *= std::pow(std::cos(pair.pinion().base_helix_angle()), 2);
  return result;
}

dynamics::PlanetaryStage stage_kinematics(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& set = geometry.rings.at(ring).set;
  const auto& point = geometry.operating_point;
  const auto& e = planetary(scene).errors;

  dynamics::PlanetaryStage stage;
  dynamics::set_kinematics(stage, set);
  stage.sun.errors = deviations_of(e.sun);
  stage.ring.errors = deviations_of(e.ring);
  stage.carrier.errors = deviations_of(e.carrier);
  for (std::size_t n = 0; n < static_cast<std::size_t>(scene.stage.planets); ++n) {
    stage.planet_errors.push_back({{e.planet_eccentricity[n], e.planet_eccentricity_phase[n]},
                                   {e.planet_pin_position[n], e.planet_pin_position_phase[n]}});
  }
  stage.held = planetary(scene).stage.held;
  stage.carrier_speed = point.computed_speed(geometry::StageMember::carrier);
  stage.ring_speed = point.computed_speed(geometry::StageMember::ring);
  stage.sun_torque = point.sun_torque;
  return stage;
}

dynamics::PlanetaryStage unsupported_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                           const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  auto stage = stage_kinematics(scene, geometry, ring);
  const auto& set = geometry.rings.at(ring).set;
  add_pitch_deviations(scene, set, sun_mesh, ring_mesh, stage);
  const auto dependence = scene.dynamics ? scene.dynamics->load_dependence : dynamics::LoadDependence::table;
  const auto excitation = [&](const MeshInput& input, const MeshResult& mesh, const geometry::GearPair& pair) {
    return excitation_of(in_transverse_section(input, pair), mesh, geometry.operating_point.mean_mesh_force, dependence,
                         pair.back_flank_phase());
  };
  stage.sun_mesh = excitation(sun_and_planets(scene).sun_planet, sun_mesh, set.sun_mesh());
  stage.ring_mesh = excitation(planetary(scene).ring_planet, ring_mesh, set.ring_mesh());
  return stage;
}

dynamics::PlanetaryStage make_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                    const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  if (!scene.dynamics) throw InternalError("internal error: dynamics of a scene without [dynamics]");
  auto stage = unsupported_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  const auto& input = planetary(scene).rings.at(ring);
  stage.sun.mass = *sun_and_planets(scene).sun.mass;
  stage.sun.inertia = *sun_and_planets(scene).sun.inertia;
  stage.ring.mass = *input.mass;
  stage.ring.inertia = *input.inertia;
  stage.carrier.mass = *planetary(scene).carrier.mass;
  stage.carrier.inertia = *planetary(scene).carrier.inertia;
  stage.planet.mass = *sun_and_planets(scene).planet.mass;
  stage.planet.inertia = *sun_and_planets(scene).planet.inertia;
  const auto supports =
      effective_supports(scene, dynamics::mean_stiffness(stage.sun_mesh), dynamics::mean_stiffness(stage.ring_mesh));
  stage.sun.support = supports.sun;
  stage.ring.support = supports.ring;
  stage.sun.torsional_support = *supports.sun_torsional;
  stage.ring.torsional_support = *supports.ring_torsional;
  stage.carrier.torsional_support = *supports.carrier_torsional;
  stage.carrier.support = supports.carrier;
  const bool play = supports.planet_clearance > 0;
  for (std::size_t n = 0; n < static_cast<std::size_t>(scene.stage.planets); ++n)
    stage.planet_bearings.push_back({.radial = supports.planet_bearing(&SupportInput::planet_radial, n),
                                     .tangential = supports.planet_bearing(&SupportInput::planet_tangential, n),
                                     .play = supports.planet_clearance / 2,
                                     .pin = play ? pin_stiffness(scene) : rigid});
  if (ring_mesh.coupling)
    stage.ring_coupling = taken_coupling(*ring_mesh.coupling, coupling_choice(scene, *ring_mesh.coupling).taken);
  if (auto coupling = planet_coupling(stage, sun_mesh, ring_mesh))
    stage.planet_coupling = std::move(coupling->compliance);
  stage.sun_half_backlash = sun_and_planets(scene).sun_planet.half_backlash.value_or(scene.dynamics->half_backlash);
  stage.ring_half_backlash = planetary(scene).ring_planet.half_backlash.value_or(scene.dynamics->half_backlash);
  stage.mesh_damping_ratio = scene.dynamics->mesh_damping_ratio;
  stage.support_damping_ratio = scene.dynamics->support_damping_ratio;
  stage.sun_mesh_damping_ratio = sun_and_planets(scene).sun_planet.damping_ratio;
  stage.ring_mesh_damping_ratio = planetary(scene).ring_planet.damping_ratio;
  stage.sun.damping_ratio = planetary(scene).supports.sun_damping;
  stage.ring.damping_ratio = planetary(scene).supports.ring_damping;
  stage.carrier.damping_ratio = planetary(scene).supports.carrier_damping;
  stage.planet.damping_ratio = planetary(scene).supports.planet_damping;
  stage.structural_damping = structural_damping(*scene.dynamics);
  const auto& set = geometry.rings.at(ring).set;
  const auto friction = [&](const geometry::GearPair& pair, const MeshResult& mesh) {
    const auto& point = geometry.operating_point;
    return flank_friction(scene, {&pair, point.mesh_frequency, point.mean_mesh_force}, mesh.shares,
                          MeshForces::transverse);
  };
  stage.sun_friction = friction(set.sun_mesh(), sun_mesh);
  stage.ring_friction = friction(set.ring_mesh(), ring_mesh);
  stage.sun_film = squeeze_film(scene, set.sun_mesh(), MeshForces::transverse);
  stage.ring_film = squeeze_film(scene, set.ring_mesh(), MeshForces::transverse);
  stage.damping_without_contact = scene.dynamics->mesh_damping == MeshDamping::always;
  stage.rotors = rotors_of(scene);
  if (moves_in_space(scene)) put_in_space(stage, scene, geometry, ring, sun_mesh, ring_mesh);
  return stage;
}

dynamics::SimulationOptions simulation_options(const Scene& scene, const dynamics::PlanetaryStage& stage) {
  auto options = accurate_simulation(scene, stage.mesh_frequency());
  // A ring on p pins repeats only after z_r / gcd(z_r, p) teeth, and with the planets after hundreds of mesh cycles:
  // the window covers them all up to a time series of some hundred megabytes.
  constexpr int longest_window = 4000;
  const int period = stage.error_period();
  options.max_window_cycles = std::max(options.max_window_cycles, std::min(period, longest_window));
  return options;
}

std::string response_id(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& options,
                        const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  return identity_of(stage, options, table_behind(stage.sun_mesh, sun_mesh.table),
                     table_behind(stage.ring_mesh, ring_mesh.table));
}

}  // namespace annulus::app
