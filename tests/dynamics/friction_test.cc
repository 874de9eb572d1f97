#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/friction/balanced_friction.h"
#include "dynamics/friction/flank_friction.h"
#include "dynamics/friction/squeeze_film.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/helical_pair/helical_pair.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrate.h"
#include "geometry/gear_pair.h"
#include "geometry/planetary.h"
#include "tests/dynamics/fixed_steps.h"
#include "tests/dynamics/stages.h"
#include "tests/geometry/gears.h"
#include "tests/verification_record.h"

/// Friction on the flanks, and the oil between them.
BOOST_AUTO_TEST_SUITE(friction)

using namespace annulus;
using namespace annulus::dynamics;
using annulus::test::Verification;
using geometry::Gear;
using geometry::GearKind;
using geometry::GearPair;
using geometry::GearRole;

namespace {

constexpr double pi = std::numbers::pi;

/// Contact ratios before and behind the pitch point, where the pinion drives.
struct Ratios {
  double before = 0, behind = 0;
  [[nodiscard]] double sum() const { return before + behind; }
};
Ratios ratios_of(const GearPair& pair) {
  const double pitch = pair.pinion().base_pitch();
  return {(pair.roll_length_pitch() - pair.roll_length_low()) / pitch,
          (pair.roll_length_high() - pair.roll_length_pitch()) / pitch};
}

GearPair spur_pair() {
  using namespace geometry::test;
  return {Gear(plain_gear(GearKind::external, 23)), Gear(plain_gear(GearKind::external, 41)), 64e-3, GearRole::pinion};
}

/// A torsional pair with equal tooth pairs.
HelicalPair lumped(const GearPair& gears, double coefficient) {
  HelicalPair pair;
  const auto body = [](const Gear& gear, double inertia) {
    return PairGear{.teeth = gear.teeth(), .mass = 1, .inertia = inertia, .radius = gear.base_radius(), .error = {}};
  };
  pair.pinion = body(gears.pinion(), 1.2e-4);
  pair.wheel = body(gears.wheel(), 1e-3);
  pair.working_angle = gears.working_pressure_angle();
  pair.mesh = ConstantStiffness{3e8};
  pair.mesh_damping_ratio = 0.05;
  pair.half_backlash = 20e-6;
  pair.pinion_speed = 200;
  pair.pinion_torque = 60;
  pair.friction = FlankFriction{coefficient, sliding_of(gears, even_shares(gears))};
  return pair;
}

/// Tooth pairs one by one, each with its force, its friction and the arms of both about the axes.
class PairByTeeth {
 public:
  /// `sense`: of the rotation, 1 or -1.
  PairByTeeth(const GearPair& gears, const HelicalPair& pair, int sense, double wheel_torque)
      : gears_(gears), pair_(pair), sense_(sense), wheel_torque_(wheel_torque) {}
  struct State {
    double pinion = 0, wheel = 0, pinion_rate = 0, wheel_rate = 0;  ///< rad beside the steady rotation, in its sense
  };
  [[nodiscard]] double force(const State& y) const {
    const double r1 = pair_.pinion.radius, r2 = pair_.wheel.radius;
    const double k = std::get<ConstantStiffness>(pair_.mesh).mean;
    const double damping = 2 * pair_.mesh_damping_ratio * std::sqrt(k * pair_.reduced_mass());
    const double delta = r1 * y.pinion - r2 * y.wheel - *pair_.half_backlash;
    return delta > 0 ? k * delta + damping * (r1 * y.pinion_rate - r2 * y.wheel_rate) : 0;
  }
  void step(double t, double h, State& y) const {
    const auto moved = [](State s, double by, const State& d) {
      s.pinion += by * d.pinion;
      s.wheel += by * d.wheel;
      s.pinion_rate += by * d.pinion_rate;
      s.wheel_rate += by * d.wheel_rate;
      return s;
    };
    const auto a = rate(t, y), b = rate(t + h / 2, moved(y, h / 2, a)), c = rate(t + h / 2, moved(y, h / 2, b)),
               d = rate(t + h, moved(y, h, c));
    const State from = y;
    y = moved(moved(moved(moved(from, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
  }

 private:
  [[nodiscard]] State rate(double t, const State& y) const {
    const double pitch = gears_.pinion().base_pitch(), f = force(y);
    const double travelled = sense_ * pair_.pinion.radius * pair_.pinion_speed * t;
    double pinion_arms = 0, wheel_arms = 0;
    int touching = 0;
    for (int n = -3; n <= 3; ++n) {
      const double from_pitch_point = std::fmod(travelled, pitch) + n * pitch;
      const double roll = gears_.roll_length_pitch() + from_pitch_point;
      if (roll < gears_.roll_length_low() || roll >= gears_.roll_length_high()) continue;
      ++touching;
      const double side = from_pitch_point < 0 ? -sense_ : sense_;
      pinion_arms += side * roll;
      wheel_arms += side * gears_.wheel_roll_length(roll);
    }
    const double mu = pair_.friction->coefficient / touching;
    return {y.pinion_rate, y.wheel_rate,
            (pair_.pinion_torque - f * (pair_.pinion.radius + mu * pinion_arms)) / pair_.pinion.inertia,
            (f * (pair_.wheel.radius + mu * wheel_arms) - wheel_torque_) / pair_.wheel.inertia};
  }

  const GearPair& gears_;
  const HelicalPair& pair_;
  int sense_;
  double wheel_torque_;
};

/// Power that a pair with even shares loses over the force.
double lost_over_force(const GearPair& gears, double coefficient, double pinion_speed) {
  const double ratio = static_cast<double>(gears.pinion().teeth()) / gears.wheel().teeth();
  return coefficient * sliding_of(gears, even_shares(gears)).distance.mean() * pinion_speed *
         (1 + (gears.internal() ? -ratio : ratio));
}

/// A stage of the ring paper with friction that has tooth pairs as in its gears.
PlanetaryStage stage_with(double coefficient) {
  using namespace geometry::test;
  auto stage = stages::ring_paper();
  const GearPair sun(paper_planet(), paper_sun(), paper_centre_distance),
      ring(paper_planet(), paper_ring(), paper_centre_distance);
  stage.sun_friction = FlankFriction{coefficient, sliding_of(sun, even_shares(sun))};
  stage.ring_friction = FlankFriction{coefficient, sliding_of(ring, even_shares(ring))};
  return stage;
}

/// Of the steady rotation, in the housing.
Eigen::VectorXd steady_velocity(const PlanetaryStage& stage, const LumpedSystem& system) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(system.dofs());
  const auto set = [&](const std::string& dof, double value) {
    if (const int i = system.find(dof); i >= 0) v[i] = value;
  };
  set("sun_u", stage.sun.radius * stage.sun_speed());
  set("carrier_u", stage.carrier.radius * stage.carrier_speed);
  set("ring_u", stage.ring.radius * stage.ring_speed);
  for (int n = 1; n <= stage.planets(); ++n) {
    const auto planet = "planet" + std::to_string(n);
    set(planet + "_u", stage.planet.radius * stage.planet_speed());
    set(planet + "_y", stage.carrier.radius * stage.carrier_speed);
  }
  return v;
}

}  // namespace

// H_V of [ISO14179-2] for spur gears with a contact ratio between 1 and 2: tooth pairs share the load evenly.
BOOST_AUTO_TEST_CASE(even_shares_of_spur_teeth) {
  Verification record("Tooth pairs that share the load evenly", "integrals over the path of contact");
  using namespace geometry::test;
  const GearPair pairs[] = {spur_pair(),
                            {paper_planet(), paper_sun(), paper_centre_distance, GearRole::pinion},
                            {paper_planet(), paper_sun(), paper_centre_distance, GearRole::wheel},
                            {paper_planet(), paper_ring(), paper_centre_distance, GearRole::pinion}};
  for (const auto& pair : pairs) {
    const auto [before, behind] = ratios_of(pair);
    const double ratio = before + behind, pitch = pair.pinion().base_pitch();
    BOOST_TEST((ratio > 1 && ratio < 2));
    // Two pairs carry half of the force each in the first and the last part of the path.
    const auto over_path = [&](auto&& integral) {
      return (integral(-before, behind - 1) + integral(1 - before, behind)) / 2 + integral(behind - 1, 1 - before);
    };
    const double distance = over_path([](double a, double b) { return (b * std::abs(b) - a * std::abs(a)) / 2; });
    const double side = over_path([](double a, double b) { return std::abs(b) - std::abs(a); });
    if (before > 0 && behind > 0)
      BOOST_TEST(std::abs(distance - (1 - ratio + before * before + behind * behind) / 2) < 1e-12);
    const auto sliding = sliding_of(pair, even_shares(pair));
    const char* origin = "256 values where pairs change";
    record.close("mean distance from the pitch point", "m", sliding.distance.mean(), pitch * distance, 5e-3, origin);
    record.near("mean side of the pitch point", "", sliding.side.mean(),
                pair.driver() == GearRole::pinion ? side : -side, 5e-3, origin);
    if (before < 0.1 || behind < 0.1) continue;
    BOOST_TEST(sliding.side(0.02) > 0.9);  // near the pitch point one pair carries
    BOOST_TEST(sliding.side(-0.02) < -0.9);
  }
}

// With an overlap ratio of 1 the contact lines together are always as long, and load is even on the field of contact.
BOOST_AUTO_TEST_CASE(even_shares_of_helical_teeth) {
  Verification record("Even load on the field of contact", "integral over the path of contact");
  using namespace geometry::test;
  const double helix = 15 * units::deg;
  auto pinion = helical(plain_gear(GearKind::external, 23), helix),
       wheel = helical(plain_gear(GearKind::external, 41), -helix);
  pinion.face_width = wheel.face_width = pi * pinion.module / std::sin(helix);
  const GearPair pair(Gear(pinion), Gear(wheel), 64e-3 / std::cos(helix), GearRole::pinion);
  BOOST_TEST(std::abs(pair.overlap_ratio() - 1) < 1e-12);
  const auto [before, behind] = ratios_of(pair);
  const auto sliding = sliding_of(pair, even_shares(pair));
  record.close("mean distance from the pitch point", "m", sliding.distance.mean(),
               pair.pinion().base_pitch() * (before * before + behind * behind) / (2 * (before + behind)), 2e-3,
               "ends of contact lines");
  record.near("mean side of the pitch point", "", sliding.side.mean(), (behind - before) / (behind + before), 2e-3,
              "ends of contact lines");
}

BOOST_AUTO_TEST_CASE(shares_are_those_of_the_pairs) {
  const auto pair = spur_pair();
  // One pair at a time, from half a cycle before the pitch point to half a cycle behind it.
  PairShares one{4, 0, {{1, 0}, {1, 0}, {0.5, 0.5}, {0, 1}}};
  const auto sliding = sliding_of(pair, one);
  const double pitch = pair.pinion().base_pitch();
  BOOST_TEST(std::abs(sliding.distance(0.25) - pitch / 4) < 1e-3 * pitch);
  BOOST_TEST(std::abs(sliding.distance(0.5) - pitch / 2) < 1e-3 * pitch);
  BOOST_TEST(std::abs(sliding.side(0.25) - 1) < 1e-12);
  BOOST_TEST(std::abs(sliding.side(0.5)) < 1e-12);
  BOOST_TEST(std::abs(sliding.side(0.75) + 1) < 1e-12);
  BOOST_CHECK_THROW((void)sliding_of(pair, {}), InputError);
}

// Bodies that move as a whole, and gears that roll, do not feel what acts across at the pitch point; the moment about
// it loses the coefficient of friction times distance, force and relative rotation.
BOOST_AUTO_TEST_CASE(work_of_friction) {
  Verification record("Power of friction of a stage", "rigid bodies");
  for (const bool backwards : {false, true}) {
    auto stage = stage_with(0.06);
    if (backwards) stage.carrier_speed *= -1;
    const auto system = assemble(stage);
    const auto rolling = steady_velocity(stage, system);
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(system.dofs());
    const auto set = [&](const std::string& dof, double value) { shift[system.find(dof)] = value; };
    for (const auto* body : {"sun", "ring", "carrier"}) {
      set(body + std::string("_x"), 1);
      set(body + std::string("_y"), 2);
    }
    for (int n = 0; n < stage.planets(); ++n) {
      const double phi = stage.planet_angles[static_cast<std::size_t>(n)];
      const auto planet = "planet" + std::to_string(n + 1);
      set(planet + "_x", std::cos(phi) + 2 * std::sin(phi));
      set(planet + "_y", -std::sin(phi) + 2 * std::cos(phi));
    }
    const double omega = stage.carrier_speed - stage.ring_speed;
    for (int m = 0; m < 2 * stage.planets(); ++m) {
      const auto& mesh = system.meshes()[static_cast<std::size_t>(m)];
      BOOST_REQUIRE(mesh.friction.size() == 2);
      const auto power = [&](const FrictionShare& share, const Eigen::VectorXd& v) {
        double sum = 0;
        for (const auto& [i, factor] : share.along) sum += factor * v[i];
        return sum;
      };
      const double teeth =
          1.0 / stage.planet_teeth + (m < stage.planets() ? 1.0 / stage.sun_teeth : -1.0 / stage.ring_teeth);
      record.near("of the force across at the pitch point", "m/s", power(mesh.friction[0], rolling), 0, 1e-12,
                  "rounding");
      record.close("of the moment, over force and distance", "rad/s", power(mesh.friction[1], rolling),
                   0.06 * std::abs(omega) * stage.ring_teeth * teeth, 1e-12, "rounding");
      record.near("of the force across in a shift of all bodies", "", power(mesh.friction[0], shift), 0, 1e-12,
                  "rounding");
    }
  }
}

// A stage whose ring is held loses the share of the rolling power that its meshes lose [Pennestri, Müller]: with
// R = z_r/z_s and the efficiency e of both meshes one behind the other (1 + R e)/(1 + R).
BOOST_AUTO_TEST_CASE(efficiency_of_a_stage) {
  Verification record("Torque that a stage delivers", "efficiency of a train of two meshes with a carrier at rest");
  using namespace geometry::test;
  const GearPair sun(paper_planet(), paper_sun(), paper_centre_distance),
      ring(paper_planet(), paper_ring(), paper_centre_distance);
  for (const bool coupled : {false, true}) {
    constexpr double coefficient = 2e-4;  // so that squares of losses vanish
    auto stage = stage_with(coefficient);
    if (coupled)
      stage.rotors = {{.name = "motor", .on = "sun", .inertia = 2, .shaft_stiffness = 1e6},
                      {.name = "mill", .on = "carrier", .inertia = 50, .shaft_stiffness = 1e8}};
    const auto system = assemble(stage);
    const double rolling = (stage.carrier_speed - stage.ring_speed) * stage.ring_teeth / stage.planet_teeth;
    const auto lost = [&](const GearPair& pair) {
      return lost_over_force(pair, coefficient, rolling) / (rolling * pair.pinion().base_radius());
    };
    const double train = 1 - lost(sun) - lost(ring), ratio = 162.0 / 48;
    const double expected = 1 - (1 + ratio * train) / (1 + ratio);
    const auto& losses = system.load(LoadCause::losses);
    const int driven = system.find(coupled ? "mill_u" : "carrier_u");
    // The inertia of all bodies takes what friction keeps away from the rotation.
    Eigen::VectorXd v = steady_velocity(stage, system);
    if (coupled) {
      v[driven] = v[system.find("carrier_u")];
      v[system.find("motor_u")] = v[system.find("sun_u")];
    }
    const Eigen::VectorXd momentum = system.mass() * v;
    const int sun_u = system.find("sun_u");
    const double delivered = losses[driven] - losses[sun_u] / momentum[sun_u] * momentum[driven];
    record.close("loss of the carrier's torque, relative", "",
                 delivered / (stage.carrier_torque() / stage.carrier.radius), expected, 2e-3,
                 "256 values per mesh cycle; squares of losses");
  }
}

// Tooth pairs one by one with constant torques, integrated with fixed steps: the curves of the lumped system, and the
// torque by which it balances friction, are not used. Forwards, and backwards under the same torque.
BOOST_AUTO_TEST_CASE(motion_of_a_pair_by_its_teeth) {
  Verification record("Friction in the motion of a pair", "every tooth pair with its arms about both axes");
  const auto gears = spur_pair();
  const auto pair = lumped(gears, 0.08);
  const auto system = assemble(pair);
  const double ratio = pair.pinion.radius / pair.wheel.radius;
  const double lost = lost_over_force(gears, 0.08, pair.pinion_speed) * pair.static_force();
  for (const int sense : {1, -1}) {
    const PairByTeeth other(gears, pair, sense,
                            pair.pinion_torque / ratio - sense * lost / (pair.pinion_speed * ratio));
    const Pacing pacing(system, {{{0, 1.0 * sense, 1}, {1, 1.0 * sense, 1}}}, "pinion_u", 1, AcceleratedBy::drive);
    PairByTeeth::State y;
    SystemState state;
    const double deflection = *pair.half_backlash + pair.static_force() / 3e8;
    state.q = Eigen::Vector2d(deflection / 2, deflection / 2);
    state.v = Eigen::VectorXd::Zero(2);
    y.pinion = deflection / 2 / pair.pinion.radius;
    y.wheel = -deflection / 2 / pair.wheel.radius;
    IntegratorOptions options;
    options.relative_tolerance = 1e-9;
    auto workspace = system.workspace();
    std::vector<double> times, forces;
    IntegrationObserver observer;
    observer.samples = 2000;
    observer.sample = [&](int, const SystemState& s) {
      times.push_back(s.time);
      forces.push_back(workspace.force[0]);
    };
    (void)integrate(system, state, 20 / pair.mesh_frequency(), options, workspace, observer, &pacing);
    double t = 0, worst = 0, most = 0, least = 1e9;
    for (std::size_t i = 0; i < times.size(); ++i) {
      annulus::test::step_to(t, times[i], 2e-7, other, y);
      worst = std::max(worst, std::abs(forces[i] - other.force(y)));
      if (i > 1000) most = std::max(most, other.force(y)), least = std::min(least, other.force(y));
    }
    BOOST_TEST(most - least > 0.02 * pair.static_force());  // friction excites
    record.at_most("mesh force, largest difference over its swing through friction", "", worst / (most - least), 0.05,
                   "pitch point passed within a 256th of a cycle; squares of losses");
  }
}

// Errors alone excite a pair without torque.
BOOST_AUTO_TEST_CASE(friction_without_torque) {
  auto pair = lumped(spur_pair(), 0.1);
  pair.pinion_torque = 0;
  const auto system = assemble(pair);
  BOOST_TEST(system.has_friction());
  BOOST_TEST(system.load(LoadCause::losses).isZero(0));
}

// What is in equilibrium does not begin to move, and small changes act as the Jacobian says.
BOOST_AUTO_TEST_CASE(equilibrium_and_slopes) {
  const auto gears = spur_pair();
  const auto pair = lumped(gears, 0.2);
  const auto system = assemble(pair);
  BOOST_TEST(system.has_friction());
  StaticSolver solver(system);
  auto workspace = system.workspace();
  for (const double t : {0.0, 1.1e-4, 3e-4}) {
    const Eigen::VectorXd q = solver.solve(t, workspace);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(4), dy(4);
    y.head(2) = q;
    system.rhs(t, y.data(), dy.data(), workspace);
    BOOST_TEST(dy.cwiseAbs().maxCoeff() < 1e-9 * workspace.force[0] / system.mass()(0, 0));
    Eigen::MatrixXd slopes(4, 4), expected(4, 4);
    y.tail(2) << 1e-3, -2e-3;
    system.jacobian(t, y.data(), slopes, workspace);
    const Eigen::Vector4d step(1e-9, 1e-9, 1e-5, 1e-5);
    for (int i = 0; i < 4; ++i) {
      Eigen::VectorXd more = y, less = y, at_more(4), at_less(4);
      more[i] += step[i];
      less[i] -= step[i];
      system.rhs(t, more.data(), at_more.data(), workspace);
      system.rhs(t, less.data(), at_less.data(), workspace);
      expected.col(i) = (at_more - at_less) / (2 * step[i]);
    }
    BOOST_TEST((slopes - expected).cwiseAbs().maxCoeff() < 1e-6 * expected.cwiseAbs().maxCoeff());
  }
}

// What torques and stiffnesses bring in over a window is what dampers and friction take, and friction excites.
BOOST_AUTO_TEST_CASE(energy_of_a_stage) {
  Verification record("Energy over a window of a stage with friction", "conservation");
  auto stage = stage_with(0.08);
  stage.planet_errors.clear();
  SimulationOptions options;
  options.other_motions.starts = 0;
  const auto response = simulate(stage, options);
  BOOST_TEST(response.steady);
  record.at_most("energy lost, relative", "", std::abs(response.energy.relative), 1e-5,
                 "tolerance of the integrator, 1e-6");
  auto without = stage;
  without.sun_friction.reset();
  without.ring_friction.reset();
  const auto smooth = simulate(without, options);
  BOOST_TEST(response.sun_planet.branches.front().dynamic_factor.value !=
             smooth.sun_planet.branches.front().dynamic_factor.value);
}

// Finite differences for the pressure between a parabola and a plane that approach each other.
BOOST_AUTO_TEST_CASE(oil_between_rolls) {
  Verification record("Oil squeezed between flanks", "Reynolds' equation by finite differences");
  const auto pair = spur_pair();
  const double viscosity = 0.04, width = 20e-3, radius = pitch_point_radius(pair);
  // 1/R = 1/(r_1 sin alpha) + 1/(r_2 sin alpha).
  BOOST_TEST(std::abs(radius - std::sin(20 * units::deg) / (1 / 23e-3 + 1 / 41e-3)) < 1e-12);
  for (const double gap : {2e-6, 20e-6}) {
    constexpr int cells = 40000;
    const double length = 400 * std::sqrt(2 * radius * gap), step = length / cells;
    // h^3 p' = 12 eta V x from the middle, where the film is symmetric, with V = 1; no pressure at the end.
    double pressure = 0, force = 0;
    for (int i = cells - 1; i >= 0; --i) {
      const double x = (i + 0.5) * step, h = gap + x * x / (2 * radius);
      const double slope = 12 * viscosity * x / (h * h * h);
      force += (pressure + slope * step / 2) * step;
      pressure += slope * step;
    }
    record.close("force over the velocity", "N s/m", squeeze_coefficient(pair, viscosity) * std::pow(gap, -1.5),
                 2 * force * width, 2e-3, "cells");
  }
}

// m v dv = -C h^(-3/2) v dh: v = v_0 - 2 C/m (h^(-1/2) - h_0^(-1/2)).
BOOST_AUTO_TEST_CASE(flanks_that_approach_through_oil) {
  Verification record("Velocity behind an oil film", "equation of motion over the gap");
  constexpr double mass = 2, half = 50e-6, coefficient = 2e-5, speed = 0.02;
  for (const int side : {1, -1}) {
    LumpedSystemBuilder builder;
    MeshElement mesh;
    mesh.name = "m";
    mesh.b = builder.add_dof("x");
    mesh.excitation = ConstantStiffness{1e8};
    mesh.damping = 100;
    mesh.half_backlash = half;
    mesh.film = SqueezeFilm{coefficient, 1e-6};
    builder.add_mass(mesh.b, mass);
    builder.add_mesh(mesh);
    const auto system = builder.build();
    auto workspace = system.workspace();
    SystemState state;
    state.q = Eigen::VectorXd::Constant(1, -0.2 * side * half);
    state.v = Eigen::VectorXd::Constant(1, side * speed);
    IntegratorOptions options;
    options.relative_tolerance = 1e-10;
    const double before = 1.2 * half;
    IntegrationObserver observer;
    observer.samples = 40;
    int compared = 0;
    observer.sample = [&](int, const SystemState& s) {
      const double gap = half - side * s.q[0];
      if (gap < 1.5e-6 || side * s.v[0] < 0) return;
      ++compared;
      record.close("velocity", "m/s", side * s.v[0],
                   speed - 2 * coefficient / mass * (1 / std::sqrt(gap) - 1 / std::sqrt(before)), 1e-6,
                   "tolerance of the integrator");
      // Jacobian by differences.
      Eigen::Vector2d y(s.q[0], s.v[0]), more, less;
      Eigen::MatrixXd slopes(2, 2);
      auto own = system.workspace();
      system.detect_contact(s.time, y.data(), own);
      system.jacobian(s.time, y.data(), slopes, own);
      for (int i = 0; i < 2; ++i) {
        const double step = i == 0 ? 1e-9 : 1e-6;
        Eigen::Vector2d up = y, down = y;
        up[i] += step;
        down[i] -= step;
        system.rhs(s.time, up.data(), more.data(), own);
        system.rhs(s.time, down.data(), less.data(), own);
        BOOST_TEST(std::abs((more[1] - less[1]) / (2 * step) - slopes(1, i)) <=
                   1e-4 * slopes.row(1).cwiseAbs().maxCoeff());
      }
    };
    (void)integrate(system, state, before / speed, options, workspace, observer);
    BOOST_TEST(compared > 10);
  }
}

// The factors of [ISO14179-2] of a pair by hand.
BOOST_AUTO_TEST_CASE(coefficient_by_oil) {
  const auto pair = spur_pair();
  // rho = r_1 sin(alpha) z_2/(z_1 + z_2) with r_1 = 23 mm; v_sum = 2 x 5 x sin(20 deg).
  const double rho = 23 * std::sin(20 * units::deg) * 41 / 64, sum = 10 * std::sin(20 * units::deg);
  const double expected = 0.048 * std::pow(300 / (sum * rho), 0.2) * std::pow(40, -0.05) * std::pow(0.5, 0.25) * 0.8;
  const MeanFilm film{
      .line_load = 300e3, .pitch_velocity = 5, .viscosity = 0.04, .roughness = 0.5e-6, .lubricant_factor = 0.8};
  BOOST_TEST(std::abs(mean_coefficient_of_friction(pair, film) - expected) < 1e-12);
  auto light = film, fast = film;
  light.line_load = 50e3;
  auto least = film;
  least.line_load = 150e3;
  BOOST_TEST(mean_coefficient_of_friction(pair, light) == mean_coefficient_of_friction(pair, least));
  fast.pitch_velocity = 80;
  auto limit = film;
  limit.pitch_velocity = 50;
  BOOST_TEST(mean_coefficient_of_friction(pair, fast) == mean_coefficient_of_friction(pair, limit));
  light.viscosity = 0;
  BOOST_CHECK_THROW((void)mean_coefficient_of_friction(pair, light), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
