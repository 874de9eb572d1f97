#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "dynamics/friction/balanced_friction.h"
#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/support.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

namespace {

/// `speed`: of the frame its x and y are measured in, for inertia and damping.
BodyForms add_central(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const CentralBody& body,
                      const std::string& name, double speed) {
  BodyForms c;
  if (body.support != rigid) {
    c.x = builder.add_dof(name + "_x");
    c.y = builder.add_dof(name + "_y");
    const double damping = critical_share(stage.damping_ratio_of(body), body.support, body.mass);
    builder.add_rotating_mass(c.x, c.y, body.mass, speed);
    builder.add_spring(c.x, body.support, damping, name + "_support_x");
    builder.add_spring(c.y, body.support, damping, name + "_support_y");
    builder.add_housing_damper_rotation(c.x, c.y, damping, speed);
  }
  if (body.torsional_support != rigid) {
    c.u = builder.add_dof(name + "_u");
    const double mass = body.inertia / (body.radius * body.radius);
    builder.add_mass(c.u, mass);
    builder.add_spring(c.u, body.torsional_support,
                       critical_share(stage.damping_ratio_of(body), body.torsional_support, mass), name + "_support_u");
  }
  return c;
}

/// The component of a planet's motion in its bearing along a unit vector (radial, tangential), with the stiffness
/// there.
MeshElement bearing_component(const PlanetaryStage& stage, const std::string& name, const LinearForm& radial,
                              const LinearForm& tangential, const Eigen::Vector2d& direction, double stiffness) {
  MeshElement element;
  element.name = name;
  element.b = direction[0] * radial + direction[1] * tangential;
  element.excitation = ConstantStiffness{stiffness};
  element.damping = critical_share(stage.damping_ratio_of(stage.planet), stiffness, stage.planet.mass);
  return element;
}

/// Where planet n sits in the carrier.
struct PlanetSeat {
  LinearForm radial, translation, tangential;  ///< translation: what of the tangential motion is no rotation
};

PlanetSeat planet_seat(const PlanetaryStage& stage, const BodyForms& carrier, int n) {
  const double phi = stage.planet_angles[n];
  const LinearForm translation = -std::sin(phi) * carrier.x + std::cos(phi) * carrier.y;
  return {std::cos(phi) * carrier.x + std::sin(phi) * carrier.y, translation, translation + carrier.u};
}

/// A bearing with play as two elements, along and across the mean pin force. Its stiffness depends on the whole load,
/// so that the centrifugal force, which else only displaces the planet, acts here.
void add_bearing_with_play(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const StageForms& bodies, int n) {
  const auto bearing = stage.planet_bearing(n);
  const auto name = "planet" + std::to_string(n + 1);
  const auto seat = planet_seat(stage, bodies.carrier, n);
  const auto& planet = bodies.planets[static_cast<std::size_t>(n)];
  const LinearForm radial = planet.x + (-1.0) * seat.radial, tangential = planet.y + (-1.0) * seat.tangential;
  const RadialBearing law(bearing.radial, bearing.play, bearing.pin);
  const double size = stage.mean_pin_force().norm();
  const Eigen::Vector2d along = stage.pin_direction();
  const double distance = law.distance(size), slope = law(distance).slope;
  const int first =
      builder.add_mesh(bearing_component(stage, name + "_bearing_along", radial, tangential, along, slope));
  const int second = builder.add_mesh(bearing_component(stage, name + "_bearing_across", radial, tangential,
                                                        {-along[1], along[0]}, distance > 0 ? size / distance : slope));
  builder.add_law({{first, second}, radial_law(law)});
  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  builder.add_load(radial, stage.planet.mass * stage.carrier.radius * speed * speed, LoadCause::rotation);
}

/// Planet n: its own DOFs where the bearing gives way, else the carrier's motion at its bearing.
BodyForms add_planet(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const BodyForms& carrier, int n) {
  const auto& body = stage.planet;
  const auto name = "planet" + std::to_string(n + 1);
  const PlanetBearing bearing = stage.planet_bearing(n);
  const auto [radial, translation, tangential] = planet_seat(stage, carrier, n);
  BodyForms p;
  const auto add_translation = [&](double stiffness, const LinearForm& seat, const char* dof, const char* direction) {
    if (stiffness == rigid) return seat;
    LinearForm own = builder.add_dof(name + dof);
    if (bearing.play == 0)
      builder.add_spring(own + (-1.0) * seat, stiffness,  // [HuFangXuShen2021, eqs. (20), (21)]
                         critical_share(stage.damping_ratio_of(body), stiffness, body.mass), name + direction);
    return own;
  };
  p.x = add_translation(bearing.radial, radial, "_x", "_bearing_radial");
  p.y = add_translation(bearing.tangential, tangential, "_y", "_bearing_tangential");
  p.u = builder.add_dof(name + "_u");
  builder.add_mass(p.u, body.inertia / (body.radius * body.radius));

  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  builder.add_rotating_mass(p.x, p.y, body.mass, speed);
  // The bearing carries the centrifugal force m a Omega^2 of the planet. Turning the carrier by u/a turns this preload
  // with it; to second order the potential is -m Omega^2/2 (x^2 + (y - u)^2 + 2 t u), t the tangential translation of
  // the carrier at the planet. Without it a rigid rotation would gain energy and run away. Corrects -m Omega^2 y_n.
  const double centrifugal = body.mass * speed * speed;
  builder.add_rotating_stiffness(p.y, carrier.u, 2 * centrifugal);
  builder.add_rotating_stiffness(carrier.u, carrier.u, -centrifugal);
  builder.add_rotating_stiffness(translation, carrier.u, -2 * centrifugal);
  return p;
}

/// 1/m_e = r_1^2/I_1 + r_2^2/I_2 [HuFangXuShen2021, eq. (31)]; a body that cannot turn counts as infinitely heavy.
double equivalent_mass(const PlanetaryStage& stage, const CentralBody& wheel) {
  const auto& planet = stage.planet;
  double inverse = planet.radius * planet.radius / planet.inertia;
  if (wheel.torsional_support != rigid) inverse += wheel.radius * wheel.radius / wheel.inertia;
  return 1 / inverse;
}

bool ring_in_housing(const PlanetaryStage& stage) { return stage.ring_coupling && !stage.ring_coupling->modes.empty(); }

/// Converts an inertial coupling from the mass of the ring's elastic body to the mass of the ring in the stage. The
/// share of the mass that moves in a mode stays the same. (A stage may omit a flange or place its mass at another
/// radius; a mixture of both masses could move more mass than there is.)
double in_mass_of_stage(double coupling, double stage_mass, double elastic_mass) {
  return elastic_mass > 0 ? coupling * std::sqrt(stage_mass / elastic_mass) : coupling;
}

/// The modes of the ring as DOFs. M couples them with the rigid motions of the ring they contain.
std::vector<LinearForm> add_ring_modes(LumpedSystemBuilder& builder, const PlanetaryStage& stage,
                                       const BodyForms& ring) {
  std::vector<LinearForm> dofs;
  if (!stage.ring_coupling) return dofs;
  const auto& body = *stage.ring_coupling;
  const double rotational_mass = stage.ring.inertia / (stage.ring.radius * stage.ring.radius);
  for (const auto& mode : body.modes) {
    const auto name = "ring_mode" + std::to_string(dofs.size() + 1);
    auto amplitude = builder.add_dof(name);
    const double rate = 2 * std::numbers::pi * mode.frequency;
    builder.add_mass(amplitude, 1);
    builder.add_spring(amplitude, rate * rate, critical_share(stage.damping_ratio_of(stage.ring), rate * rate, 1),
                       name);
    builder.add_mass_coupling(amplitude, ring.x, in_mass_of_stage(mode.translation_x, stage.ring.mass, body.mass));
    builder.add_mass_coupling(amplitude, ring.y, in_mass_of_stage(mode.translation_y, stage.ring.mass, body.mass));
    builder.add_mass_coupling(amplitude, ring.u,
                              in_mass_of_stage(mode.rotation, rotational_mass, body.rotational_mass));
    dofs.push_back(std::move(amplitude));
  }
  return dofs;
}

double value_or_zero(const std::vector<double>& values, int n) { return values.empty() ? 0.0 : values[n]; }

/// Shares of the ring's motion in the approach of the mesh at angle psi = phi_n + a_r [HuFangXuShen2021, eq. (16)],
/// while the carrier turns past the housing: -sin(psi + Omega t) x + cos(psi + Omega t) y + sum of displacement of the
/// mode at the tooth in mesh x modal amplitude.
std::vector<MovingShare> ring_shares(const PlanetaryStage& stage, const BodyForms& ring,
                                     const std::vector<LinearForm>& modes, double psi) {
  std::vector<MovingShare> shares;
  const double speed = stage.carrier_speed;
  for (const auto& [form, amount, phase] :
       {std::tuple{&ring.x, -1.0, psi}, std::tuple{&ring.y, 1.0, psi + std::numbers::pi / 2}})
    for (const auto& [dof, factor] : *form) shares.push_back({dof, {}, {amount * factor, speed, phase}});
  for (std::size_t k = 0; k < modes.size(); ++k)
    shares.push_back({modes[k].front().first, PeriodicCurve(stage.ring_coupling->modes[k].deflection, 1), {}});
  return shares;
}

MeshCoupling through_ring(const PlanetaryStage& stage, const std::vector<LinearForm>& modes) {
  MeshCoupling coupling;
  coupling.body = "ring_body";
  for (int n = 0; n < stage.planets(); ++n) coupling.meshes.push_back(stage.planets() + n);
  coupling.compliance = compliance_curves(stage.ring_coupling->compliance, stage.ring_coupling->per_cycle);
  for (std::size_t k = 0; k < modes.size(); ++k)
    coupling.retained.push_back(
        {modes[k].front().first, std::pow(2 * std::numbers::pi * stage.ring_coupling->modes[k].frequency, 2)});
  return coupling;
}

/// Phase of the ring mesh of a planet at time 0, mesh cycles.
double ring_mesh_phase(const PlanetaryStage& stage, int n) {
  return value_or_zero(stage.ring_tooth_offset, n) - value_or_zero(stage.ring_phase_lag, n);
}

/// Compliance between the ring and the sun mesh of a planet, beyond what the laws for equal forces contain.
Eigen::Matrix2d beyond_equal_forces(double compliance) {
  return compliance * (Eigen::Matrix2d() << -1, 1, 1, -1).finished();
}

MeshCoupling through_planet(const PlanetaryStage& stage, int n) {
  std::vector<Eigen::MatrixXd> matrices;
  for (const double compliance : stage.planet_coupling) matrices.emplace_back(beyond_equal_forces(compliance));
  return {{stage.planets() + n, n},
          compliance_curves(matrices, static_cast<int>(stage.planet_coupling.size())),
          {},
          "planet_body"};
}

/// Ring meshes, then sun meshes. The curves through the ring are read at least as finely as those through the planets.
MeshCoupling through_ring_and_planets(const PlanetaryStage& stage, MeshCoupling ring) {
  const int planets = stage.planets(), phases = static_cast<int>(stage.planet_coupling.size());
  const PeriodicCurve through_planet(stage.planet_coupling, phases);
  const int given = stage.ring_coupling->per_cycle, finer = (phases + given - 1) / given, per_cycle = finer * given;
  std::vector<Eigen::MatrixXd> matrices(stage.ring_coupling->compliance.size() * static_cast<std::size_t>(finer),
                                        Eigen::MatrixXd::Zero(2 * planets, 2 * planets));
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    auto& matrix = matrices[i];
    const double at = static_cast<double>(i) / per_cycle;
    std::size_t entry = 0;
    for (int row = 0; row < planets; ++row)
      for (int column = 0; column <= row; ++column, ++entry)
        matrix(row, column) = matrix(column, row) = ring.compliance[entry](at);
    for (int n = 0; n < planets; ++n) {
      const std::array<int, 2> own{n, planets + n};
      const double later = ring_mesh_phase(stage, n) - ring_mesh_phase(stage, 0);
      matrix(own, own) += beyond_equal_forces(through_planet(at + later));
    }
  }
  ring.body = "ring_and_planets";
  for (int n = 0; n < planets; ++n) ring.meshes.push_back(n);
  ring.compliance = compliance_curves(matrices, per_cycle);
  return ring;
}

void add_couplings(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const std::vector<LinearForm>& modes) {
  const bool planets = !stage.planet_coupling.empty();
  if (stage.ring_coupling) {
    auto ring = through_ring(stage, modes);
    return builder.add_mesh_coupling(planets ? through_ring_and_planets(stage, std::move(ring)) : std::move(ring));
  }
  for (int n = 0; planets && n < stage.planets(); ++n) builder.add_mesh_coupling(through_planet(stage, n));
}

StageForms add_bodies_in_plane(LumpedSystemBuilder& builder, const PlanetaryStage& stage) {
  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  StageForms bodies;
  bodies.sun = add_central(builder, stage, stage.sun, "sun", speed);
  bodies.ring = add_central(builder, stage, stage.ring, "ring", ring_in_housing(stage) ? 0 : speed);
  bodies.carrier = add_central(builder, stage, stage.carrier, "carrier", speed);
  for (int n = 0; n < stage.planets(); ++n) bodies.planets.push_back(add_planet(builder, stage, bodies.carrier, n));
  return bodies;
}

/// Spreads the meshes of a stage in space over their faces, which takes their backlash.
void spread_meshes(std::vector<MeshElement>& meshes, LumpedSystemBuilder& builder, const PlanetaryStage& stage,
                   const StageForms& bodies) {
  std::vector<MeshElement> tilts;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const int planets = stage.planets(), n = static_cast<int>(m) % planets;
    const bool of_sun = static_cast<int>(m) < planets;
    auto& mesh = meshes[m];
    const auto [approach, tilt] = mesh_out_of_plane(stage, bodies, of_sun ? MeshWith::sun : MeshWith::ring, n);
    mesh.b = mesh.b + approach;
    tilts.push_back(spread_over_face(builder, mesh, of_sun ? stage.space->sun_face : stage.space->ring_face, tilt,
                                     static_cast<int>(m), static_cast<int>(meshes.size() + m)));
  }
  for (auto& tilt : tilts) meshes.push_back(std::move(tilt));
}

/// The whole laws of bearings and of what they stand on.
void add_laws(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const StageForms& bodies) {
  const auto& space = *stage.space;
  const double length = stage.carrier.radius;
  for (const auto& bearing : space.bearings)
    add_bearing_law(builder, bearing, bearing_motion(stage, bodies, bearing), length);
  for (const auto& coupling : space.couplings) {
    std::vector<LinearForm> motion;
    for (const std::size_t i : coupling.bearings)
      for (auto& form : bearing_motion(stage, bodies, space.bearings[i])) motion.push_back(std::move(form));
    if (coupling.turned) motion.push_back(bodies.ring.u);
    add_coupling_law(builder, coupling, space, motion, length);
  }
}

/// x and y of a body in the middle of a face.
std::array<LinearForm, 2> at_face(const BodyForms& body, const std::optional<StageSpace>& space,
                                  SpreadFace StageSpace::*face) {
  if (!space) return {body.x, body.y};
  auto coordinates = at_place(against(body, seat_in_housing()), ((*space).*face).middle);
  return {std::move(coordinates[0]), std::move(coordinates[1])};
}

/// n = (-sin psi, cos psi) with psi = phi - a_s of sun meshes, where the contact moves along n, and psi = phi + a_r of
/// ring meshes, where it moves the other way.
std::vector<FrictionShare> mesh_friction(const PlanetaryStage& stage, const StageForms& bodies, MeshWith with, int n) {
  const bool of_sun = with == MeshWith::sun;
  const auto& friction = of_sun ? stage.sun_friction : stage.ring_friction;
  if (!friction) return {};
  const auto& wheel = of_sun ? bodies.sun : bodies.ring;
  const auto& planet = bodies.planets[static_cast<std::size_t>(n)];
  const auto face = of_sun ? &StageSpace::sun_face : &StageSpace::ring_face;
  const int sign = of_sun ? 1 : -1;
  const double alpha = of_sun ? stage.sun_working_angle : stage.ring_working_angle;
  const double psi = stage.planet_angles[static_cast<std::size_t>(n)] - sign * alpha;
  PitchPointMotion motion;
  if (of_sun || !ring_in_housing(stage)) {
    const auto [x, y] = at_face(wheel, stage.space, face);
    motion.across = (-std::cos(psi)) * x + (-std::sin(psi)) * y;
  }
  const auto [radial, tangential] = at_face(planet, stage.space, face);
  motion.across = motion.across + std::cos(alpha) * radial + (-sign * std::sin(alpha)) * tangential +
                  (sign * std::tan(alpha)) * (wheel.u + sign * planet.u);
  motion.rotation = (1 / (of_sun ? stage.sun : stage.ring).radius) * wheel.u + (-1 / stage.planet.radius) * planet.u;
  const double rate = stage.mesh_rate();
  return friction_shares(*friction, motion, {.contact = sign, .rotation = rate > 0 ? 1 : rate < 0 ? -1 : 0});
}

}  // namespace

LumpedSystem assemble(const PlanetaryStage& stage) {
  stage.check();
  LumpedSystemBuilder builder;
  const bool housing = ring_in_housing(stage);
  const StageForms bodies = stage.space ? add_bodies_in_space(builder, stage) : add_bodies_in_plane(builder, stage);
  const auto& [sun, ring, carrier, planets] = bodies;
  const double as = stage.sun_working_angle, ar = stage.ring_working_angle;

  const auto mesh = [&](const std::string& name, LinearForm b, const MeshExcitation& excitation,
                        const CentralBody& wheel, std::optional<double> half_backlash, double phase,
                        std::vector<HarmonicError> errors, const std::vector<std::vector<ToothError>>& tooth_errors,
                        int planet) {
    MeshElement element;
    element.name = name;
    element.b = std::move(b);
    element.excitation = excitation;
    element.frequency = stage.mesh_rate();
    element.phase_offset = phase;
    const auto& own = &wheel == &stage.sun ? stage.sun_mesh_damping_ratio : stage.ring_mesh_damping_ratio;
    element.damping = critical_share(own.value_or(stage.mesh_damping_ratio), mean_stiffness(excitation),
                                     equivalent_mass(stage, wheel));
    element.half_backlash = half_backlash;
    element.damping_without_contact = stage.damping_without_contact;
    element.errors = std::move(errors);
    if (!tooth_errors.empty()) element.tooth_errors = tooth_errors[static_cast<std::size_t>(planet)];
    return element;
  };

  std::vector<MeshElement> meshes, ring_meshes;
  const auto ring_modes = add_ring_modes(builder, stage, ring);
  const LinearForm none;
  for (int n = 0; n < stage.planets(); ++n) {
    const double phi = stage.planet_angles[n];
    const auto number = std::to_string(n + 1);
    const BodyForms& p = planets[n];
    // [HuFangXuShen2021, eqs. (15), (16)]
    const LinearForm sun_b = sun.u + (-std::sin(phi - as)) * sun.x + std::cos(phi - as) * sun.y + p.u +
                             (-std::sin(as)) * p.x + (-std::cos(as)) * p.y;
    const LinearForm ring_b = ring.u + (-std::sin(phi + ar)) * (housing ? none : ring.x) +
                              std::cos(phi + ar) * (housing ? none : ring.y) + (-1.0) * p.u + std::sin(ar) * p.x +
                              (-std::cos(ar)) * p.y;
    meshes.push_back(mesh("sun_planet" + number, sun_b, stage.sun_mesh, stage.sun, stage.sun_half_backlash,
                          -value_or_zero(stage.sun_phase_lag, n), sun_mesh_errors(stage, n), stage.sun_tooth_errors,
                          n));
    ring_meshes.push_back(mesh("ring_planet" + number, ring_b, stage.ring_mesh, stage.ring, stage.ring_half_backlash,
                               ring_mesh_phase(stage, n), ring_mesh_errors(stage, n), stage.ring_tooth_errors, n));
    if (housing) ring_meshes.back().moving = ring_shares(stage, ring, ring_modes, phi + ar);
    meshes.back().film = stage.sun_film;
    ring_meshes.back().film = stage.ring_film;
    meshes.back().friction = mesh_friction(stage, bodies, MeshWith::sun, n);
    ring_meshes.back().friction = mesh_friction(stage, bodies, MeshWith::ring, n);
  }
  for (auto& element : ring_meshes) meshes.push_back(std::move(element));
  if (stage.space) spread_meshes(meshes, builder, stage, bodies);
  for (auto& element : meshes) builder.add_mesh(std::move(element));
  if (stage.space && stage.space->laws == BearingLaws::whole) add_laws(builder, stage, bodies);
  add_couplings(builder, stage, ring_modes);
  for (int n = 0; n < stage.planets(); ++n)
    if (!stage.space && stage.planet_bearing(n).play > 0) add_bearing_with_play(builder, stage, bodies, n);

  const auto ends = stage.shaft_ends();
  for (const auto& [name, form] : {std::pair{"sun", &sun.u}, {"ring", &ring.u}, {"carrier", &carrier.u}}) {
    const auto end = std::find_if(ends.begin(), ends.end(), [&](const auto& e) { return e.name == name; });
    if (end->load != 0) builder.add_load(*form, end->load, LoadCause::torque);
  }
  return with_balanced_friction(
      with_structural_damping(with_rotors(builder.build(), stage.rotors, ends), stage.structural_damping), stage.rotors,
      ends);
}

}  // namespace annulus::dynamics
