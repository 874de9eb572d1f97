#include "dynamics/systems/planetary/planetary_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "core/errors.h"
#include "dynamics/system/input_checks.h"
#include "geometry/planetary.h"

namespace annulus::dynamics {

namespace {

void check_errors(const BodyErrors& errors, const std::string& name) {
  for (const auto& d : {errors.eccentricity, errors.position})
    if (!std::isfinite(d.amount) || !std::isfinite(d.phase))
      throw InputError(fmt::format("{}: error {} m and phase {} rad must be finite", name, d.amount, d.phase));
}

void check_central(const CentralBody& body, const std::string& name) {
  check_positive(body.mass, name + " mass");
  check_positive(body.inertia, name + " inertia");
  check_positive(body.radius, name + " radius");
  check_support(body.support, name + " support", ZeroStiffness::allowed);
  check_support(body.torsional_support, name + " torsional support", ZeroStiffness::allowed);
  check_errors(body.errors, name);
}

bool has_errors(const BodyErrors& errors) { return errors.eccentricity.exists() || errors.position.exists(); }

bool any_errors(const PlanetaryStage& stage) {
  return !stage.sun_tooth_errors.empty() || !stage.ring_tooth_errors.empty() || has_errors(stage.sun.errors) ||
         has_errors(stage.ring.errors) || has_errors(stage.carrier.errors) ||
         std::any_of(stage.planet_errors.begin(), stage.planet_errors.end(), has_errors);
}

void check_coupling(const RingCoupling& coupling, const PlanetaryStage& stage) {
  const auto refuse = [](const std::string& what) { throw InputError("ring coupling: " + what); };
  if (coupling.planets != stage.planets())
    refuse(fmt::format("made for {} planets, the stage has {}", coupling.planets, stage.planets()));
  if (coupling.ring_teeth != stage.ring_teeth)
    refuse(fmt::format("made for {} ring teeth, the stage has {}", coupling.ring_teeth, stage.ring_teeth));
  const auto matrices = static_cast<int>(coupling.compliance.size());
  if (coupling.per_cycle < 1 || matrices < 1 || matrices % coupling.per_cycle)
    refuse(fmt::format("{} compliance matrices do not fill mesh cycles at {} per cycle", matrices, coupling.per_cycle));
  for (const auto& matrix : coupling.compliance) {
    if (matrix.rows() != stage.planets() || matrix.cols() != stage.planets() || !matrix.allFinite())
      refuse(fmt::format("a compliance matrix is {} x {}; it must hold {} x {} finite numbers", matrix.rows(),
                         matrix.cols(), stage.planets(), stage.planets()));
    // Tolerates what a file of a few digits leaves of the symmetry.
    const double difference = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
    if (difference > 1e-6 * matrix.cwiseAbs().maxCoeff())
      refuse(fmt::format("a compliance matrix differs from its transpose by {:g} m/N", difference));
  }
  for (const auto& mode : coupling.modes) {
    check_positive(mode.frequency, "ring coupling: frequency of a mode");
    if (static_cast<int>(mode.deflection.size()) != coupling.ring_teeth)
      refuse(fmt::format("a mode has {} displacements for {} teeth", mode.deflection.size(), coupling.ring_teeth));
    for (const double value : {mode.translation_x, mode.translation_y, mode.rotation})
      if (!std::isfinite(value))
        refuse(fmt::format("the inertial coupling {} of the mode at {} Hz is not finite", value, mode.frequency));
  }
}

void check_planet_coupling(const PlanetaryStage& stage) {
  if (stage.planet_coupling.empty()) return;
  const double sun = mean_tangent_stiffness(stage.sun_mesh), ring = mean_tangent_stiffness(stage.ring_mesh);
  for (const double c : stage.planet_coupling)
    if (!std::isfinite(c) || !(c * (sun + ring) < 1))
      throw InputError(fmt::format(
          "the meshes of a planet deflect each other by {:.4g} m/N through its rim: with their stiffnesses, "
          "{:.4g} and {:.4g} N/m under equal forces, it has to be below {:.4g} m/N",
          c, sun, ring, 1 / (sun + ring)));
}

/// rad/s, of the carrier against the ring: it sets the mesh frequency.
double rolling_speed(const PlanetaryStage& s) { return s.carrier_speed - s.ring_speed; }

// A stage at rest (for its modes) needs no numbers of teeth.
double rate_of_planet(const PlanetaryStage& s) {
  const double speed = rolling_speed(s);
  return speed == 0 ? 0 : -speed * s.ring_teeth / s.planet_teeth;
}
double rate_of_sun(const PlanetaryStage& s) {
  const double speed = rolling_speed(s);
  return speed == 0 ? 0 : speed * s.ring_teeth / s.sun_teeth;
}

/// Mesh cycles in which the housing turns past the carrier a whole number of times.
int cycles_of_housing(const PlanetaryStage& s) {
  if (s.carrier_speed == 0) return 1;
  if (s.ring_speed == 0) return s.ring_teeth;
  constexpr int longest = 100000;
  constexpr double whole = 1e-9;  // rounding of the speeds
  const double turns = s.carrier_speed / (rolling_speed(s) * s.ring_teeth);
  for (int cycles = 1; cycles <= longest; ++cycles)
    if (std::abs(std::remainder(cycles * turns, 1)) <= whole * cycles * std::abs(turns)) return cycles;
  return PlanetaryStage::never_repeats;
}

void add(std::vector<HarmonicError>& list, double sign, const Deviation& deviation, double rate, double phase) {
  if (deviation.exists()) list.push_back({sign * deviation.amount, rate, deviation.phase + phase});
}

}  // namespace

double PlanetaryStage::sun_speed() const { return carrier_speed + rate_of_sun(*this); }
double PlanetaryStage::planet_speed() const { return carrier_speed + rate_of_planet(*this); }

// A displacement d of the planet's toothing reduces the deflection of the sun mesh by d . n_s, n_s = (-sin(phi_n -
// a_s), cos(phi_n - a_s)). With delta = ... - e this is e = +|d| sin(angle of d - phi_n + a_s). A displacement of the
// sun increases it: e = -... The ring mesh likewise with n_r = (-sin(phi_n + a_r), cos(phi_n + a_r)).
std::vector<HarmonicError> sun_mesh_errors(const PlanetaryStage& s, int n) {
  return sun_mesh_errors(s, n, s.sun_working_angle);
}
std::vector<HarmonicError> ring_mesh_errors(const PlanetaryStage& s, int n) {
  return ring_mesh_errors(s, n, s.ring_working_angle);
}

std::vector<HarmonicError> sun_mesh_errors(const PlanetaryStage& s, int n, double alpha) {
  std::vector<HarmonicError> list;
  const double phi = s.planet_angles[n], turn = -s.carrier_speed;
  if (!s.planet_errors.empty()) {
    add(list, +1, s.planet_errors[n].eccentricity, rate_of_planet(s), alpha);
    add(list, +1, s.planet_errors[n].position, 0, alpha - phi);
  }
  add(list, -1, s.sun.errors.eccentricity, rate_of_sun(s), alpha - phi);
  add(list, -1, s.sun.errors.position, turn, alpha - phi);
  add(list, +1, s.carrier.errors.eccentricity, 0, alpha - phi);
  add(list, +1, s.carrier.errors.position, turn, alpha - phi);
  return list;
}

std::vector<HarmonicError> ring_mesh_errors(const PlanetaryStage& s, int n, double alpha) {
  std::vector<HarmonicError> list;
  const double phi = s.planet_angles[n], turn = -s.carrier_speed;
  if (!s.planet_errors.empty()) {
    add(list, +1, s.planet_errors[n].eccentricity, rate_of_planet(s), -alpha);
    add(list, +1, s.planet_errors[n].position, 0, -alpha - phi);
  }
  add(list, -1, s.ring.errors.eccentricity, -rolling_speed(s), -alpha - phi);
  add(list, -1, s.ring.errors.position, turn, -alpha - phi);
  add(list, +1, s.carrier.errors.eccentricity, 0, -alpha - phi);
  add(list, +1, s.carrier.errors.position, turn, -alpha - phi);
  return list;
}

PlanetBearing PlanetaryStage::planet_bearing(int n) const {
  if (planet_bearings.empty()) return {};
  return planet_bearings.size() == 1 ? planet_bearings.front() : planet_bearings[static_cast<std::size_t>(n)];
}

Eigen::Vector2d PlanetaryStage::mean_pin_force() const {
  const double force = mean_mesh_force(), speed = rotating_frame ? bearing_speed.value_or(carrier_speed) : 0;
  return {force * (std::sin(sun_working_angle) - std::sin(ring_working_angle)) +
              planet.mass * carrier.radius * speed * speed,
          force * (std::cos(sun_working_angle) + std::cos(ring_working_angle))};
}

Eigen::Vector2d PlanetaryStage::pin_direction() const {
  const Eigen::Vector2d force = mean_pin_force();
  return force.norm() > 0 ? Eigen::Vector2d(force.normalized()) : Eigen::Vector2d::UnitY();
}

double PlanetaryStage::mesh_rate() const { return ring_teeth * rolling_speed(*this) / (2 * std::numbers::pi); }

double PlanetaryStage::mesh_frequency() const { return std::abs(mesh_rate()); }

double PlanetaryStage::mean_mesh_force() const { return sun_torque / (planets() * sun.radius); }

double PlanetaryStage::carrier_torque() const { return sun_torque * (1 + static_cast<double>(ring_teeth) / sun_teeth); }

int PlanetaryStage::error_period() const {
  int period = common_period(period_in_cycles(sun_mesh), period_in_cycles(ring_mesh));
  if (ring_coupling) {
    const auto matrices = static_cast<int>(ring_coupling->compliance.size());
    period = common_period(period, matrices / ring_coupling->per_cycle);
    if (!ring_coupling->modes.empty()) period = common_period(period, ring_teeth);
  }
  if (rolling_speed(*this) == 0) return period;
  period = common_period(period, ripple_period(rotors, shaft_ends(), mesh_frequency()));
  const auto eccentric = [](const BodyErrors& e) { return e.eccentricity.exists(); };
  if (std::any_of(planet_errors.begin(), planet_errors.end(), eccentric)) period = common_period(period, planet_teeth);
  for (const auto* errors : {&sun_tooth_errors, &ring_tooth_errors})
    for (const auto& of_mesh : *errors)
      for (const auto& error : of_mesh)
        period = common_period(period, static_cast<int>(std::lround(error.curve.period())));
  if (sun.errors.eccentricity.exists()) period = common_period(period, sun_teeth);
  if (ring.errors.eccentricity.exists()) period = common_period(period, ring_teeth);
  if (sun.errors.position.exists() || ring.errors.position.exists() || carrier.errors.position.exists() ||
      (space && space->depends_on_carrier_angle()))
    period = common_period(period, cycles_of_housing(*this));
  return period;
}

std::vector<ShaftEnd> PlanetaryStage::shaft_ends() const {
  using geometry::StageMember;
  std::vector<ShaftEnd> ends{{"planet", planet.radius, "planets move around the axis"}};
  // The loads from virtual work equal T_c / a with T_c = T_s (1 + z_r/z_s), and T_r / r_r. They are balanced to
  // rounding, so that a stage free to turn does not creep away.
  const double force = force_at(sun.radius, sun_torque);
  const double of_carrier = -force * (std::cos(sun_working_angle) + std::cos(ring_working_angle));
  for (const auto& [member, speed, load] : {std::tuple{StageMember::sun, sun_teeth > 0 ? sun_speed() : 0.0, force},
                                            {StageMember::ring, ring_speed, force},
                                            {StageMember::carrier, carrier_speed, of_carrier}})
    ends.push_back({to_string(member), body(member).radius, body(member).torsional_support == rigid ? "it is held" : "",
                    speed, held == member ? 0.0 : load});
  return ends;
}

void PlanetaryStage::check() const {
  check_central(sun, "sun");
  check_central(ring, "ring");
  check_central(carrier, "carrier");
  check_positive(planet.mass, "planet mass");
  check_positive(planet.inertia, "planet inertia");
  check_positive(planet.radius, "planet radius");
  for (const auto& bearing : planet_bearings) {
    check_support(bearing.radial, "planet bearing stiffness (radial)", ZeroStiffness::refused);
    check_support(bearing.tangential, "planet bearing stiffness (tangential)", ZeroStiffness::refused);
    check_support(bearing.pin, "stiffness of a planet pin", ZeroStiffness::refused);
    check_not_negative(bearing.play, "play of a planet bearing");
    if (bearing.play > 0 && (bearing.radial != bearing.tangential || bearing.radial == rigid))
      throw InputError(fmt::format(
          "a planet bearing with play needs one finite stiffness in all directions, not {} N/m radially and "
          "{} N/m tangentially",
          bearing.radial, bearing.tangential));
  }
  if (planets() < 1) throw InputError(fmt::format("a planetary stage needs at least one planet, not {}", planets()));
  for (const double angle : planet_angles)
    if (!std::isfinite(angle)) throw InputError(fmt::format("planet angle {} rad must be finite", angle));
  const auto per_planet = [&](std::size_t size, const std::string& name) {
    if (size != 0 && size != planet_angles.size())
      throw InputError(fmt::format("{} has {} values for {} planets", name, size, planets()));
  };
  if (planet_bearings.size() != 1) per_planet(planet_bearings.size(), "planet bearings");
  per_planet(planet_errors.size(), "planet errors");
  per_planet(sun_tooth_errors.size(), "tooth errors of the sun meshes");
  per_planet(ring_tooth_errors.size(), "tooth errors of the ring meshes");
  for (const auto* errors : {&sun_tooth_errors, &ring_tooth_errors})
    for (const auto& of_mesh : *errors)
      for (const auto& error : of_mesh)
        if (!(error.curve.period() >= 1) || !std::isfinite(error.phase_offset))
          throw InputError(fmt::format("a tooth error repeats after {} mesh cycles from {} on: it needs at least one",
                                       error.curve.period(), error.phase_offset));
  per_planet(sun_phase_lag.size(), "sun mesh phase");
  per_planet(ring_phase_lag.size(), "ring mesh phase");
  per_planet(ring_tooth_offset.size(), "ring tooth offset");
  for (const auto& e : planet_errors) check_errors(e, "planet");
  for (const double angle : {sun_working_angle, ring_working_angle})
    if (!(std::abs(angle) < std::numbers::pi / 2))
      throw InputError(fmt::format("working pressure angle {} rad must lie below 90 degrees", angle));
  dynamics::check(sun_mesh, "sun-planet mesh");
  for (const auto* friction : {&sun_friction, &ring_friction})
    check_not_negative(*friction ? (*friction)->coefficient : 0, "coefficient of friction");
  dynamics::check(ring_mesh, "ring-planet mesh");
  if (ring_coupling) check_coupling(*ring_coupling, *this);
  check_planet_coupling(*this);
  check_rotors(rotors, shaft_ends());
  if (space) space->check(planets());
  if (space && ring_coupling && !ring_coupling->modes.empty())
    throw InputError(fmt::format("a ring that moves along the axis and tilts has none of its {} elastic modes",
                                 ring_coupling->modes.size()));
  if (sun_half_backlash) check_not_negative(*sun_half_backlash, "half backlash of the sun meshes");
  if (ring_half_backlash) check_not_negative(*ring_half_backlash, "half backlash of the ring meshes");
  check_not_negative(mesh_damping_ratio, "mesh damping ratio");
  check_not_negative(support_damping_ratio, "support damping ratio");
  for (const auto& [ratio, name] : {std::pair{&sun_mesh_damping_ratio, "damping ratio of the sun meshes"},
                                    {&ring_mesh_damping_ratio, "damping ratio of the ring meshes"},
                                    {&sun.damping_ratio, "damping ratio of the sun's support"},
                                    {&ring.damping_ratio, "damping ratio of the ring's support"},
                                    {&carrier.damping_ratio, "damping ratio of the carrier's support"},
                                    {&planet.damping_ratio, "damping ratio of the planet bearings"}})
    check_not_negative(ratio->value_or(0), name);
  structural_damping.check();
  for (const auto& [speed, name] : {std::pair{carrier_speed, "carrier"}, {ring_speed, "ring"}})
    if (!std::isfinite(speed)) throw InputError(fmt::format("{} speed {} rad/s must be finite", name, speed));
  if (held && sun_teeth > 0 && ring_teeth > 0) {
    using geometry::StageMember;
    const auto speeds = geometry::member_speeds(sun_teeth, ring_teeth, {StageMember::carrier, carrier_speed},
                                                {StageMember::ring, ring_speed});
    const double fastest =
        std::max({std::abs(speeds[StageMember::sun]), std::abs(carrier_speed), std::abs(ring_speed)});
    constexpr double rounding = 1e-9;
    if (std::abs(speeds[*held]) > rounding * fastest)
      throw InputError(fmt::format("the {} is held and turns at {} rad/s", to_string(*held), speeds[*held]));
  }
  if (ring_speed != 0 && ring_coupling && !ring_coupling->modes.empty())
    throw InputError(
        fmt::format("the elastic modes of a ring that turns (here at {} rad/s) are not modelled: they would need its "
                    "Coriolis forces; leave them out",
                    ring_speed));
  if (!std::isfinite(sun_torque)) throw InputError(fmt::format("sun torque {} N m must be finite", sun_torque));
  // Without teeth there are natural frequencies, but no mesh frequency, torque ratio or rate of the errors.
  if ((carrier_speed != 0 || ring_speed != 0 || sun_torque != 0 || any_errors(*this)) &&
      !(sun_teeth > 0 && planet_teeth > 0 && ring_teeth > 0))
    throw InputError(
        fmt::format("speed, torque and errors need the numbers of teeth of sun, planet and ring, not {}, {} and {}",
                    sun_teeth, planet_teeth, ring_teeth));
  if (sun_torque != 0) {
    for (const auto member : geometry::stage_members)
      if (body(member).torsional_support == rigid && held != member)
        throw InputError(
            fmt::format("the {} cannot turn (rigid torsional support), so its torque would not reach the meshes; the "
                        "torque of the sun is {} N m",
                        to_string(member), sun_torque));
    // Per metre of carrier motion the sun moves (cos a_s + cos a_r) metres: virtual work against the tooth ratio.
    const double ratio = carrier.radius * (std::cos(sun_working_angle) + std::cos(ring_working_angle)) / sun.radius;
    const double expected = 1 + static_cast<double>(ring_teeth) / sun_teeth;
    if (std::abs(ratio - expected) > 1e-3 * expected)
      throw InputError(
          fmt::format("carrier radius, working angles and sun base radius give the torque ratio {:.6g}, the teeth give "
                      "{:.6g}: the inputs contradict each other",
                      ratio, expected));
  }
}

void set_kinematics(PlanetaryStage& stage, const geometry::PlanetarySet& set) {
  stage.sun_teeth = set.sun().teeth();
  stage.planet_teeth = set.planet().teeth();
  stage.ring_teeth = set.ring().teeth();
  stage.sun.radius = set.sun().base_radius();
  stage.planet.radius = set.planet().base_radius();
  stage.ring.radius = set.ring().base_radius();
  stage.carrier.radius = set.centre_distance();
  stage.sun_working_angle = set.sun_mesh().working_pressure_angle();
  stage.ring_working_angle = set.ring_mesh().working_pressure_angle();
  stage.planet_angles.clear();
  stage.sun_phase_lag.clear();
  stage.ring_phase_lag.clear();
  stage.ring_tooth_offset.clear();
  for (int n = 0; n < set.planets(); ++n) {
    stage.planet_angles.push_back(set.planet_angle(n));
    stage.sun_phase_lag.push_back(set.sun_phase_lag(n));
    stage.ring_phase_lag.push_back(set.ring_phase_lag(n));
    stage.ring_tooth_offset.push_back(set.ring_tooth_offset(n));
  }
}

}  // namespace annulus::dynamics
