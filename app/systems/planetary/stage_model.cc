
#include <algorithm>

#include "app/model/excitation.h"
#include "app/model/stiff_supports.h"
#include "app/plan/accuracy_choice.h"
#include "app/results/content_id.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

void add_coupling(ContentId& id, const RingCoupling& coupling) {
  id.add("coupling.per_cycle", coupling.per_cycle).add("mass", coupling.mass).add("turn", coupling.rotational_mass);
  for (const auto& matrix : coupling.compliance) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) id.add("D", matrix.data()[i]);
  }
  for (const auto& mode : coupling.modes) {
    id.add("mode", mode.frequency).add("x", mode.translation_x).add("y", mode.translation_y).add("u", mode.rotation);
    for (const double closing : mode.closing) id.add("closing", closing);
  }
}

void add_deviation(ContentId& id, const std::string& name, const dynamics::BodyErrors& e) {
  id.add(name + ".E", e.eccentricity.amount).add(name + ".E_phase", e.eccentricity.phase);
  id.add(name + ".A", e.position.amount).add(name + ".A_phase", e.position.phase);
}

void add_body(ContentId& id, const std::string& name, const dynamics::CentralBody& body) {
  id.add(name + ".mass", body.mass).add(name + ".inertia", body.inertia).add(name + ".radius", body.radius);
  id.add(name + ".support", body.support).add(name + ".torsional", body.torsional_support);
  add_deviation(id, name, body.errors);
}

dynamics::BodyErrors deviations_of(const BodyErrorInput& e) {
  return {{e.eccentricity, e.eccentricity_phase}, {e.position, e.position_phase}};
}

}  // namespace

dynamics::PlanetaryStage make_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                    const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  if (!scene.dynamics) throw InternalError("internal error: dynamics of a scene without [dynamics]");
  const auto& input = scene.rings.at(ring);
  const auto& set = geometry.rings.at(ring).set;
  const auto& point = geometry.operating_point;
  const auto& e = scene.errors;

  dynamics::PlanetaryStage stage;
  dynamics::set_kinematics(stage, set);
  stage.sun.mass = *scene.sun.mass;
  stage.sun.inertia = *scene.sun.inertia;
  stage.sun.torsional_support = scene.supports.sun_torsional;
  stage.sun.errors = deviations_of(e.sun);
  stage.ring.mass = *input.mass;
  stage.ring.inertia = *input.inertia;
  stage.ring.errors = deviations_of(e.ring);
  stage.carrier.mass = *scene.carrier.mass;
  stage.carrier.inertia = *scene.carrier.inertia;
  stage.carrier.torsional_support = scene.supports.carrier_torsional;
  stage.carrier.errors = deviations_of(e.carrier);
  stage.planet.mass = *scene.planet.mass;
  stage.planet.inertia = *scene.planet.inertia;
  for (std::size_t n = 0; n < static_cast<std::size_t>(scene.stage.planets); ++n) {
    stage.planet_errors.push_back({{e.planet_eccentricity[n], e.planet_eccentricity_phase[n]},
                                   {e.planet_pin_position[n], e.planet_pin_position_phase[n]}});
  }
  stage.sun_mesh = excitation_of(scene.sun_planet, sun_mesh, point.mean_mesh_force, scene.dynamics->load_dependence);
  stage.ring_mesh = excitation_of(scene.ring_planet, ring_mesh, point.mean_mesh_force, scene.dynamics->load_dependence);
  const auto supports =
      effective_supports(scene, dynamics::mean_stiffness(stage.sun_mesh), dynamics::mean_stiffness(stage.ring_mesh));
  stage.sun.support = supports.sun;
  stage.ring.support = supports.ring;
  stage.ring.torsional_support = supports.ring_torsional;
  stage.carrier.support = supports.carrier;
  stage.planet.bearing_radial = stage.planet.bearing_tangential = supports.planet;
  if (ring_mesh.coupling)
    stage.ring_coupling = taken_coupling(*ring_mesh.coupling, coupling_choice(scene, *ring_mesh.coupling).taken);
  stage.sun_half_backlash = scene.sun_planet.half_backlash.value_or(scene.dynamics->half_backlash);
  stage.ring_half_backlash = scene.ring_planet.half_backlash.value_or(scene.dynamics->half_backlash);
  stage.mesh_damping_ratio = scene.dynamics->mesh_damping_ratio;
  stage.support_damping_ratio = scene.dynamics->support_damping_ratio;
  stage.damping_without_contact = scene.dynamics->mesh_damping == MeshDamping::always;
  stage.carrier_speed = point.carrier_speed;
  stage.sun_torque = point.sun_torque;
  return stage;
}

dynamics::SimulationOptions simulation_options(const Scene& scene, const dynamics::PlanetaryStage& stage) {
  auto options = given_simulation(*scene.dynamics, stage.mesh_frequency());
  const auto choice = motion_choice(scene.accuracy);
  options.samples_per_cycle = choice.samples_per_cycle;
  options.confirm = choice.confirm;
  options.confirm_on_contact_loss = true;
  options.steady_tolerance = std::max(options.steady_tolerance, choice.steady_tolerance);
  if (!scene.dynamics->relative_tolerance) options.integrator.relative_tolerance = choice.relative_tolerance;
  // A ring on p pins repeats only after z_r / gcd(z_r, p) teeth, and with the planets after hundreds of mesh cycles:
  // the window covers them all up to a time series of some hundred megabytes.
  constexpr int longest_window = 4000;
  const int period = stage.error_period();
  options.max_window_cycles = std::max(options.max_window_cycles, std::min(period, longest_window));
  return options;
}

std::string response_id(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& options,
                        const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  ContentId id;
  add_body(id, "sun", stage.sun);
  add_body(id, "ring", stage.ring);
  add_body(id, "carrier", stage.carrier);
  id.add("planet.mass", stage.planet.mass)
      .add("planet.inertia", stage.planet.inertia)
      .add("planet.radius", stage.planet.radius);
  id.add("planet.radial", stage.planet.bearing_radial).add("planet.tangential", stage.planet.bearing_tangential);
  for (const auto& errors : stage.planet_errors) add_deviation(id, "planet", errors);
  for (const auto* list :
       {&stage.planet_angles, &stage.sun_phase_lag, &stage.ring_phase_lag, &stage.ring_tooth_offset}) {
    for (const double value : *list) id.add("kinematics", value);
  }
  id.add("sun_angle", stage.sun_working_angle).add("ring_angle", stage.ring_working_angle);
  id.add("teeth", stage.sun_teeth).add("teeth", stage.planet_teeth).add("teeth", stage.ring_teeth);
  add_excitation(id, "sun_mesh", stage.sun_mesh, sun_mesh.table);
  add_excitation(id, "ring_mesh", stage.ring_mesh, ring_mesh.table);
  if (stage.ring_coupling) add_coupling(id, *stage.ring_coupling);
  id.add("sun_half_backlash", stage.sun_half_backlash.value_or(-1));
  id.add("ring_half_backlash", stage.ring_half_backlash.value_or(-1)).add("mesh_damping", stage.mesh_damping_ratio);
  id.add("support_damping", stage.support_damping_ratio).add("always", stage.damping_without_contact ? 1 : 0);
  id.add("carrier_speed", stage.carrier_speed).add("sun_torque", stage.sun_torque);
  id.add("rotating_frame", stage.rotating_frame ? 1 : 0);
  add_simulation(id, options);
  return id.id();
}

}  // namespace annulus::app
