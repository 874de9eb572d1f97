#include <Eigen/Core>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "core/radial_bearing.h"
#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/planetary/bearing_forces.h"
#include "dynamics/systems/planetary/stage_motion.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(bearings_with_play)

using namespace annulus::dynamics;
using annulus::RadialBearing;

/// Forces of rollers by themselves: N of them around the bearing, each of stiffness 4 K / N, which pushes where its
/// raceways have approached each other by more than the play.
struct Rollers {
  double stiffness, play;
  int count;

  [[nodiscard]] Eigen::Vector2d force(const Eigen::Vector2d& motion) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / count;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      sum += 4 * stiffness / count * std::max(0.0, motion.dot(direction) - play) * direction;
    }
    return sum;
  }
};

// Rollers one by one against the law: 20000 of them leave the trapezoidal rule, whose error falls with the square of
// their number over the load zone; the narrowest here is 16 degrees wide, (20000 x 16 / 360)^-2 = 1e-6. The law adds
// 1e-7 of the stiffness.
BOOST_AUTO_TEST_CASE(many_rollers_give_the_law) {
  annulus::test::Verification record("Bearing with play", "20000 linear rollers one by one");
  const double k = 7e8, play = 15e-6;
  const Rollers rollers{k, play, 20000};
  const RadialBearing law(k, play);
  double force = 0, zone = 0;
  for (const double distance : {15.15e-6, 17e-6, 25e-6, 60e-6, 500e-6}) {
    const Eigen::Vector2d sum = rollers.force({0.6 * distance, -0.8 * distance});
    BOOST_TEST(std::abs(sum[0] + 0.75 * sum[1]) <= 1e-6 * sum.norm());  // along the motion
    const double expected = (1 - 1e-7) * sum.norm() + 1e-7 * k * distance;
    force = std::max(force, std::abs(law(distance).force / expected - 1));
    zone = std::max(zone, std::abs(law.load_zone(law(distance).force) - 2 * std::acos(play / distance)));
  }
  record.at_most("force at five distances, largest relative difference", "", force, 3e-6, "trapezoidal rule");
  BOOST_TEST(zone <= 1e-6);
}

// Their sum along the load, by the trapezoidal rule: the load has kinks at the ends of its zone.
BOOST_AUTO_TEST_CASE(loads_of_rollers_add_up_to_the_force) {
  annulus::test::Verification record("Rollers of a bearing with play", "equilibrium with the force");
  constexpr int steps = 20000;
  for (const double seat : {std::numeric_limits<double>::infinity(), 3e8}) {
    const RadialBearing law(7e8, 15e-6, seat);
    for (const double force : {5e3, 5e4, 5e5}) {
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double angle = 2 * std::numbers::pi * i / steps;
        sum += law.roller_load(force, angle) * std::cos(angle) * 2 * std::numbers::pi / steps;
      }
      record.near("sum of the loads over the force", "", sum / force, 1, 3e-6,
                  "trapezoidal rule, rest of the stiffness");
      BOOST_TEST(law.roller_load(force, 0.51 * law.load_zone(force)) == 0);
      BOOST_TEST(law.roller_load(force, 0.49 * law.load_zone(force)) > 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(slope_energy_and_distance_belong_to_the_force) {
  for (const double seat : {std::numeric_limits<double>::infinity(), 3e8}) {
    const RadialBearing law(1e9, 10e-6, seat);
    for (const double d : {1e-6, 9.9e-6, 10.001e-6, 10.4e-6, 13e-6, 40e-6}) {
      BOOST_TEST_CONTEXT("seat " << seat << ", distance " << d) {
        const double step = 1e-4 * std::abs(d - 10e-6);
        const double slope = (law(d + step).force - law(d - step).force) / (2 * step);
        const double gain = law.energy(d + step) - law.energy(d - step), work = law(d).force * 2 * step;
        BOOST_TEST(std::abs(slope / law(d).slope - 1) <= 1e-6);
        BOOST_TEST(std::abs(gain - work) <= 1e-6 * work + 1e-16 * 1e9 * d * d);
        BOOST_TEST(std::abs(law.distance(law(d).force) / d - 1) <= 1e-12);
      }
    }
    BOOST_TEST(law(0).force == 0);
    BOOST_TEST(law.distance(0) == 0);
  }
  const RadialBearing without(1e9, 0, 1e9);
  BOOST_TEST(std::abs(without(2e-6).force / 1e3 - 1) <= 1e-12);
  BOOST_TEST(without.load_zone(1) == std::numbers::pi);
  BOOST_CHECK_THROW(RadialBearing(0, 1e-6), annulus::InputError);
  BOOST_CHECK_THROW(RadialBearing(rigid, 1e-6), annulus::InputError);
  BOOST_CHECK_THROW(RadialBearing(1e9, -1e-6), annulus::InputError);
  BOOST_CHECK_THROW(RadialBearing(1e9, 1e-6, 0), annulus::InputError);
}

PlanetaryStage with_play(double play, double pin = rigid) {
  auto stage = stages::ring_paper();
  stage.planet_bearings = {{.radial = 1e9, .tangential = 1e9, .play = play, .pin = pin}};
  return stage;
}

// The whole stage in equilibrium, with the rollers of its bearings one by one as the peer: the motions that the solver
// finds, put into the rollers, have to carry the mesh forces. 4000 rollers over a load zone of 90 degrees or more:
// (4000 / 4)^-2 = 1e-6.
BOOST_AUTO_TEST_CASE(planets_rest_on_their_rollers) {
  annulus::test::Verification record("A stage with play in its planet bearings",
                                     "statics: 4000 linear rollers one by one carry the mesh forces");
  double worst = 0;
  for (const double play : {2e-6, 20e-6, 100e-6}) {
    const auto stage = with_play(play);
    const auto system = assemble(stage);
    const Rollers rollers{1e9, play, 4000};
    const auto times = Eigen::VectorXd::LinSpaced(7, 0, 3 / stage.mesh_frequency());
    const auto path = static_path(system, times);
    const double as = stage.sun_working_angle, ar = stage.ring_working_angle;
    const double centrifugal = stage.planet.mass * stage.carrier.radius * std::pow(stage.carrier_speed, 2);
    for (Eigen::Index i = 0; i < times.size(); ++i)
      for (int n = 0; n < stage.planets(); ++n) {
        const auto at = [&](const std::string& dof) { return path.displacement(system.find(dof), i); };
        const auto planet = "planet" + std::to_string(n + 1);
        const double phi = stage.planet_angles[n];
        const Eigen::Vector2d motion(
            at(planet + "_x") - std::cos(phi) * at("carrier_x") - std::sin(phi) * at("carrier_y"),
            at(planet + "_y") + std::sin(phi) * at("carrier_x") - std::cos(phi) * at("carrier_y") - at("carrier_u"));
        const double sun = path.force(n, i), ring = path.force(stage.planets() + n, i);
        const Eigen::Vector2d pressing(std::sin(as) * sun - std::sin(ar) * ring + centrifugal,
                                       std::cos(as) * sun + std::cos(ar) * ring);
        worst = std::max(worst, (rollers.force(motion) - pressing).norm() / pressing.norm());
      }
  }
  record.at_most("what is left of five planets' loads, relative, three plays", "", worst, 2e-6,
                 "trapezoidal rule over the load zone");
}

BOOST_AUTO_TEST_CASE(without_play_nothing_changes) {
  const double pin = 2e9;
  auto plain = stages::ring_paper();
  plain.planet_bearings = {{1 / (1 / 1e9 + 1 / pin), 1 / (1 / 1e9 + 1 / pin)}};
  const auto small = with_play(1e-14, pin);
  const auto a = assemble(plain), b = assemble(small);
  const auto times = Eigen::VectorXd::LinSpaced(5, 0, 1 / plain.mesh_frequency());
  const auto forces = static_path(a, times).force, same = static_path(b, times).force;
  BOOST_TEST((forces - same.topRows(forces.rows())).cwiseAbs().maxCoeff() <= 1e-6 * forces.cwiseAbs().maxCoeff());
  const auto frequencies = modes(a), others = modes(b);
  for (std::size_t i = 0; i < frequencies.modes.size(); ++i)
    BOOST_TEST(std::abs(frequencies.modes[i].frequency - others.modes[i].frequency) <=
               1e-6 * frequencies.modes.back().frequency);
}

// A light load with large errors leaves planets without load: they stand somewhere in their play, and the others carry
// all of it.
BOOST_AUTO_TEST_CASE(unloaded_planets_have_a_place) {
  for (const double share : {1.0, 0.1, 1e-2, 1e-3}) {
    auto stage = with_play(60e-6, 5e8);
    stage.sun_torque *= share;
    const auto system = assemble(stage);
    const auto times = Eigen::VectorXd::LinSpaced(200, 0, 55 / stage.mesh_frequency());
    const auto path = static_path(system, times);
    const Eigen::RowVectorXd sum = path.force.topRows(stage.planets()).colwise().sum();
    const double expected = stage.planets() * stage.mean_mesh_force();
    BOOST_TEST((sum.array() / expected - 1).abs().maxCoeff() <= 1e-9 / share);
  }
}

// The equations of motion: the Jacobian against differences, and energy against power along a motion.
BOOST_AUTO_TEST_CASE(jacobian_and_energy_are_those_of_the_motion) {
  const auto system = assemble(with_play(20e-6, 4e8));
  auto w = system.workspace();
  const int n = system.dofs();
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Eigen::VectorXd y = stages::random_state(n, seed);
    system.detect_contact(0.01, y.data(), w);
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    system.jacobian(0.01, y.data(), jacobian, w);
    Eigen::VectorXd up(2 * n), down(2 * n);
    double worst = 0;
    for (int j = 0; j < n; ++j) {
      constexpr double step = 1e-10;
      Eigen::VectorXd moved = y;
      moved[j] += step;
      system.rhs(0.01, moved.data(), up.data(), w);
      moved[j] -= 2 * step;
      system.rhs(0.01, moved.data(), down.data(), w);
      worst = std::max(worst, ((up - down) / (2 * step) - jacobian.col(j)).cwiseAbs().maxCoeff());
    }
    BOOST_TEST(worst <= 1e-4 * jacobian.cwiseAbs().maxCoeff());
  }
}

// Harmonic balance and time integration, which share the law alone, find the same motion; the pins carry T_c / (N a)
// in the mean, and the energy balances.
BOOST_AUTO_TEST_CASE(both_methods_find_the_motion) {
  const auto stage = with_play(15e-6);
  SimulationOptions options;
  options.confirmation = Confirmation::always;
  const auto response = simulate(stage, options);
  BOOST_TEST(response.steady);
  BOOST_TEST(response.confirmed);
  BOOST_REQUIRE(response.steady_difference.has_value());
  BOOST_TEST(*response.steady_difference <= 1e-3);
  BOOST_TEST(std::abs(response.energy.relative) <= 2e-3);
  const auto pins = annulus::dynamics::bearing_forces(stage, response.series);
  const double mean = stage.carrier_torque() / (stage.planets() * stage.carrier.radius);
  BOOST_TEST(std::abs(pins.tangential.mean() / mean - 1) <= 1e-3);
  const double centrifugal = stage.planet.mass * stage.carrier.radius * std::pow(stage.carrier_speed, 2);
  const double across =
      stage.mean_mesh_force() * (std::sin(stage.sun_working_angle) - std::sin(stage.ring_working_angle));
  BOOST_TEST(std::abs(pins.radial.mean() - centrifugal - across) <= 1e-3 * mean);
}

// A frequency with play is that of a stage whose bearings have the stiffnesses of small motions at the mean load.
BOOST_AUTO_TEST_CASE(frequencies_are_those_at_the_mean_load) {
  auto stage = with_play(15e-6);
  stage.carrier_speed = 0;
  const RadialBearing law(1e9, 15e-6);
  const double force = stage.mean_pin_force().norm(), distance = law.distance(force);
  auto linear = stages::ring_paper();
  linear.carrier_speed = 0;
  // The mean force is all but tangential: 0.4 degrees off.
  linear.planet_bearings = {{force / distance, law(distance).slope}};
  const auto found = modes(assemble(stage)), expected = modes(assemble(linear));
  for (std::size_t i = 0; i < expected.modes.size(); ++i)
    BOOST_TEST(std::abs(found.modes[i].frequency - expected.modes[i].frequency) <=
               1e-3 * expected.modes[i].frequency + 1e-6);
}

BOOST_AUTO_TEST_CASE(bearings_with_play_are_checked) {
  const auto refused = [](PlanetBearing bearing) {
    auto stage = stages::ring_paper();
    stage.planet_bearings = {bearing};
    try {
      (void)assemble(stage);
      return false;
    } catch (const annulus::InputError&) {
      return true;
    }
  };
  BOOST_TEST(refused({1e9, 2e9, 1e-6}));
  BOOST_TEST(refused({rigid, rigid, 1e-6}));
  BOOST_TEST(refused({1e9, 1e9, -1e-6}));
  BOOST_TEST(refused({1e9, 1e9, 1e-6, 0}));
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("x"), y = builder.add_dof("y");
  builder.add_mass(x, 1);
  builder.add_mass(y, 1);
  MeshElement element;
  element.b = x;
  element.excitation = ConstantStiffness{1};
  const int first = builder.add_mesh(element);
  element.b = y;
  element.half_backlash = 1;
  const int second = builder.add_mesh(element);
  builder.add_law({{first, second}, radial_law(RadialBearing(1, 1))});
  BOOST_CHECK_THROW((void)builder.build(), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
