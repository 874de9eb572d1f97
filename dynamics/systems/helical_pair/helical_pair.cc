#include "dynamics/systems/helical_pair/helical_pair.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "core/errors.h"
#include "dynamics/friction/balanced_friction.h"
#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/system/input_checks.h"
#include "dynamics/system/periods.h"
#include "geometry/iso6336.h"

namespace annulus::dynamics {

namespace {

void check_gear(const PairGear& gear, const std::string& name) {
  if (gear.teeth < 1) throw InputError(fmt::format("{} teeth = {} must be positive", name, gear.teeth));
  check_positive(gear.mass, name + " mass");
  check_positive(gear.inertia, name + " inertia");
  check_positive(gear.radius, name + " base radius");
  check_support(gear.bearing_transverse, name + " bearing stiffness (transverse)", ZeroStiffness::refused);
  check_support(gear.bearing_axial, name + " bearing stiffness (axial)", ZeroStiffness::refused);
}

void check_wave(const ErrorWave& wave, const std::string& name) {
  if (!std::isfinite(wave.amount) || !std::isfinite(wave.phase))
    throw InputError(fmt::format("{}: amount {} m and phase {} rad must be finite", name, wave.amount, wave.phase));
}

struct PairCoordinates {
  LinearForm y, z, u;
};

PairCoordinates add_gear(LumpedSystemBuilder& builder, const PairGear& gear, double of_pair, const std::string& name) {
  PairCoordinates c;
  const double damping_ratio = gear.damping_ratio.value_or(of_pair);
  const auto add_translation = [&](double bearing, const char* dof, const char* direction) {
    if (bearing == rigid) return LinearForm{};
    LinearForm own = builder.add_dof(name + dof);
    builder.add_mass(own, gear.mass);
    builder.add_spring(own, bearing, critical_share(damping_ratio, bearing, gear.mass), name + direction);
    return own;
  };
  c.y = add_translation(gear.bearing_transverse, "_y", "_bearing_transverse");
  c.z = add_translation(gear.bearing_axial, "_z", "_bearing_axial");
  c.u = builder.add_dof(name + "_u");
  builder.add_mass(c.u, gear.inertia / (gear.radius * gear.radius));
  return c;
}

/// With the normal n = c e - s z of the flanks and a contact at rho_T + z, n . (phi x rho) = c phi . (rho_T x e) - s
/// phi . (rho_T x z) + c z phi . (z x e); the first term is the plane's u.
struct PairInSpace {
  PairCoordinates pinion, wheel;
  LinearForm approach, tilt;  ///< of the mesh, normal, beside that of the plane
  LinearForm across{};        ///< PitchPointMotion::across, beside that of the rotations
};

/// Pinion, wheel.
std::vector<BodyForms> add_bodies(LumpedSystemBuilder& builder, const HelicalPair& pair) {
  const auto& space = *pair.space;
  const auto body = [&](StageBody::Kind kind, const PairGear& gear, double tilting, double place, double spin) {
    return SpaceBody{{kind},      gear.mass, gear.inertia,
                     gear.radius, tilting,   place,
                     spin,        0,         gear.damping_ratio.value_or(pair.bearing_damping_ratio)};
  };
  return add_space_bodies(
      builder, space,
      {body(StageBody::Kind::pinion, pair.pinion, space.tilt_inertia_pinion, space.mass_place_pinion,
            pair.pinion_speed),
       body(StageBody::Kind::wheel, pair.wheel, space.tilt_inertia_wheel, space.mass_place_wheel, -pair.wheel_speed())},
      {0, 0}, [](const auto&, const auto&, const auto&) { return seat_in_housing(); });
}

PairInSpace add_in_space(LumpedSystemBuilder& builder, const HelicalPair& pair) {
  const auto& space = *pair.space;
  const auto forms = add_bodies(builder, pair);
  const auto &p = forms[0], &w = forms[1];
  const double c = std::cos(pair.base_helix_angle), s = std::sin(pair.base_helix_angle);
  const double cos_a = std::cos(pair.working_angle), sin_a = std::sin(pair.working_angle);
  // About the common tangent of the pitch circles.
  const auto about_tangent = [&](const BodyForms& f) { return (-sin_a) * f.tilt_x + cos_a * f.tilt_y; };
  const LinearForm slope = (-c) * (p.tilt_x + (-1.0) * w.tilt_x);
  PairInSpace result{{p.y, p.z, p.u}, {w.y, w.z, w.u}, space.face.middle * slope, (space.face.width / 2) * slope};
  const auto x_at_face = [&](const BodyForms& body) {
    return at_place(against(body, seat_in_housing()), space.face.middle).front();
  };
  result.across = x_at_face(w) + (-1.0) * x_at_face(p);
  if (s != 0)
    result.approach = result.approach + s * (space.working_radius_pinion * about_tangent(p) +
                                             space.working_radius_wheel * about_tangent(w));
  return result;
}

double yield_of(double stiffness) { return stiffness == rigid ? 0 : 1 / stiffness; }

/// m/N along the normal, of the bearings of a pair in space, whose gears do not turn.
double compliance_of_supports(const HelicalPair& pair) {
  const auto system = assemble(pair);
  std::vector<Eigen::Index> kept;
  for (int i = 0; i < system.dofs(); ++i)
    if (!system.names()[static_cast<std::size_t>(i)].ends_with("_u")) kept.push_back(i);
  if (kept.empty()) return 0;
  const Eigen::VectorXd b = system.mesh_vector(0)(kept);
  const Eigen::MatrixXd stiffness = system.stiffness()(kept, kept);
  return b.dot(stiffness.completeOrthogonalDecomposition().solve(b));
}

void check_torque(const HelicalPair& pair) {
  if (!std::isfinite(pair.pinion_torque))
    throw InputError(fmt::format("pinion torque {} N m must be finite", pair.pinion_torque));
}

}  // namespace

double HelicalPair::wheel_speed() const { return pinion_speed * pinion.teeth / wheel.teeth; }

double HelicalPair::wheel_torque() const { return pinion_torque * wheel.radius / pinion.radius; }

std::vector<ShaftEnd> HelicalPair::shaft_ends() const {
  // Equal on both, which is T_2/r_2 = T_1/r_1 balanced to rounding: a pair free to turn does not creep away.
  const double load = force_at(pinion.radius, pinion_torque);
  return {{"pinion", pinion.radius, "", pinion_speed, load},
          {"wheel", wheel.radius, "", wheel.teeth > 0 ? wheel_speed() : 0, load}};
}

double HelicalPair::mesh_frequency() const { return pinion.teeth * pinion_speed / (2 * std::numbers::pi); }

double HelicalPair::static_force() const { return pinion_torque / (pinion.radius * std::cos(base_helix_angle)); }

double HelicalPair::reduced_mass() const {
  return 1 / (pinion.radius * pinion.radius / pinion.inertia + wheel.radius * wheel.radius / wheel.inertia);
}

double HelicalPair::static_compliance() const {
  if (space) return 1 / mean_stiffness(mesh) + compliance_of_supports(*this);
  const double c = std::cos(base_helix_angle), s = std::sin(base_helix_angle);
  return 1 / mean_stiffness(mesh) + c * c * (yield_of(pinion.bearing_transverse) + yield_of(wheel.bearing_transverse)) +
         s * s * (yield_of(pinion.bearing_axial) + yield_of(wheel.bearing_axial));
}

int HelicalPair::error_period() const {
  int period = period_in_cycles(mesh);
  if (pinion.error.exists()) period = std::lcm(period, pinion.teeth);
  if (wheel.error.exists()) period = std::lcm(period, wheel.teeth);
  if (!rotors.empty() && mesh_frequency() > 0)
    period = common_period(period, ripple_period(rotors, shaft_ends(), mesh_frequency()));
  return period;
}

void HelicalPair::check() const {
  check_gear(pinion, "pinion");
  check_gear(wheel, "wheel");
  if (!(std::abs(base_helix_angle) < std::numbers::pi / 2))
    throw InputError(fmt::format("base helix angle {} rad must lie below 90 degrees", base_helix_angle));
  const double ratio = wheel.radius / pinion.radius, expected = static_cast<double>(wheel.teeth) / pinion.teeth;
  if (std::abs(ratio - expected) > 1e-3 * expected)
    throw InputError(fmt::format(
        "base radii give the ratio {:.6g}, the teeth give {:.6g}: the inputs contradict each other", ratio, expected));
  dynamics::check(mesh, "mesh");
  check_wave(mesh_error, "error at mesh frequency");
  check_wave(pinion.error, "error of the pinion");
  check_wave(wheel.error, "error of the wheel");
  if (half_backlash) check_not_negative(*half_backlash, "half backlash");
  check_not_negative(mesh_damping_ratio, "mesh damping ratio");
  check_not_negative(bearing_damping_ratio, "bearing damping ratio");
  check_not_negative(pinion.damping_ratio.value_or(0), "damping ratio of the pinion's bearings");
  check_not_negative(wheel.damping_ratio.value_or(0), "damping ratio of the wheel's bearings");
  structural_damping.check();
  check_not_negative(pinion_speed, "pinion speed");
  check_rotors(rotors, shaft_ends());
  check_torque(*this);
  if (friction) check_not_negative(friction->coefficient, "coefficient of friction");
  if (!space) return;
  space->check_supports();
  space->face.check("mesh");
  check_positive(space->tilt_inertia_pinion, "tilting inertia of the pinion");
  check_positive(space->tilt_inertia_wheel, "tilting inertia of the wheel");
  check_positive(space->working_radius_pinion, "working radius of the pinion");
  check_positive(space->working_radius_wheel, "working radius of the wheel");
  if (pinion_torque < 0)
    throw InputError(
        fmt::format("pinion torque {} N m: a pair in space has driving flanks alone; mirror it", pinion_torque));
}

double base_helix_angle(double helix_angle, double normal_pressure_angle) {
  return std::asin(std::sin(helix_angle) * std::cos(normal_pressure_angle));
}

double iso_6336_mesh_stiffness(const Iso6336Mesh& mesh) {
  const auto [face_width, transverse_contact_ratio, helix_angle, single_stiffness] = mesh;
  check_positive(face_width, "face width");
  check_positive(single_stiffness, "single stiffness");
  if (!std::isfinite(transverse_contact_ratio) || !(transverse_contact_ratio >= 1))
    throw InputError(fmt::format("transverse contact ratio {} must be at least 1", transverse_contact_ratio));
  if (!(std::abs(helix_angle) < std::numbers::pi / 2))
    throw InputError(fmt::format("helix angle {} rad must lie below 90 degrees", helix_angle));
  return single_stiffness * std::cos(helix_angle) * geometry::mesh_over_single_stiffness(transverse_contact_ratio) *
         face_width;
}

LumpedSystem assemble(const HelicalPair& pair) {
  pair.check();
  LumpedSystemBuilder builder;
  const auto bodies = pair.space ? add_in_space(builder, pair)
                                 : PairInSpace{add_gear(builder, pair.pinion, pair.bearing_damping_ratio, "pinion"),
                                               add_gear(builder, pair.wheel, pair.bearing_damping_ratio, "wheel"),
                                               {},
                                               {}};
  const auto &pinion = bodies.pinion, &wheel = bodies.wheel;
  const double c = std::cos(pair.base_helix_angle), s = std::sin(pair.base_helix_angle);

  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = c * (pinion.y + pinion.u + (-1.0) * wheel.y + wheel.u);
  if (s != 0) mesh.b = mesh.b + (-s) * pinion.z + s * wheel.z;
  mesh.b = mesh.b + bodies.approach;
  mesh.excitation = pair.mesh;
  mesh.frequency = pair.mesh_frequency();
  mesh.damping = critical_share(pair.mesh_damping_ratio, mean_stiffness(pair.mesh), pair.reduced_mass());
  mesh.half_backlash = pair.half_backlash;
  mesh.damping_without_contact = pair.damping_without_contact;
  const auto add_error = [&](const ErrorWave& wave, double rate) {
    if (wave.exists()) mesh.errors.push_back({wave.amount, rate, wave.phase});
  };
  add_error(pair.mesh_error, 2 * std::numbers::pi * pair.mesh_frequency());
  add_error(pair.pinion.error, pair.pinion_speed);
  add_error(pair.wheel.error, pair.wheel_speed());
  mesh.film = pair.film;
  if (pair.friction)
    mesh.friction =
        friction_shares(*pair.friction,
                        {.across = bodies.across + std::tan(pair.working_angle) * (pinion.u + wheel.u),
                         .rotation = (1 / pair.pinion.radius) * pinion.u + (-1 / pair.wheel.radius) * wheel.u},
                        {.contact = 1, .rotation = pair.pinion_speed > 0 ? 1 : 0});
  std::optional<MeshElement> tilt;
  if (pair.space) tilt = spread_over_face(builder, mesh, pair.space->face, bodies.tilt, 0, 1);
  builder.add_mesh(std::move(mesh));
  if (tilt) builder.add_mesh(std::move(*tilt));
  if (pair.space && pair.space->laws == BearingLaws::whole) {
    const auto motions = bearing_coordinates(pair);
    for (std::size_t i = 0; i < motions.size(); ++i)
      add_bearing_law(builder, pair.space->bearings[i], motions[i], pair.pinion.radius);
  }

  const auto ends = pair.shaft_ends();
  builder.add_load(pinion.u, ends.front().load, LoadCause::torque);
  builder.add_load(wheel.u, ends.back().load, LoadCause::torque);
  return with_balanced_friction(
      with_structural_damping(with_rotors(builder.build(), pair.rotors, ends), pair.structural_damping), pair.rotors,
      ends);
}

std::vector<std::vector<LinearForm>> bearing_coordinates(const HelicalPair& pair) {
  std::vector<std::vector<LinearForm>> list;
  if (!pair.space) return list;
  LumpedSystemBuilder builder;
  const auto forms = add_bodies(builder, pair);
  for (const auto& b : pair.space->bearings)
    list.push_back(
        at_place(against(forms[b.body.kind == StageBody::Kind::pinion ? 0 : 1], seat_in_housing()), b.place));
  return list;
}

Modes modes(const HelicalPair& pair) { return modes(assemble(pair)); }

}  // namespace annulus::dynamics
