#include "dynamics/modes/growth.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "core/errors.h"
#include "dynamics/friction/flank_friction.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/planetary/response.h"
#include "geometry/gear_pair.h"
#include "tests/dynamics/stages.h"
#include "tests/geometry/gears.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(growth_of_motions)

using namespace annulus;
using namespace annulus::dynamics;

constexpr double omega = 1000, zeta = 0.02;  // of a planet on its bearing, rad/s

/// Only the planets move, on their bearings: all else is rigid, and the meshes have next to no stiffness.
PlanetaryStage planets_alone(double tangential, double carrier_speed) {
  auto stage = stages::lin_parker(3);
  stage.sun_teeth = 48;
  stage.planet_teeth = 57;
  stage.ring_teeth = 162;
  for (auto* body : {&stage.sun, &stage.ring, &stage.carrier}) body->support = body->torsional_support = rigid;
  stage.planet.mass = 2;
  stage.planet_bearings = {{2 * omega * omega, tangential}};
  stage.sun_mesh = stage.ring_mesh = ConstantStiffness{1e-3};
  stage.support_damping_ratio = zeta;
  stage.carrier_speed = carrier_speed;
  return stage;
}

bool refused(const LumpedSystem& system) {
  try {
    refuse_growth(system, 1000);
  } catch (const InputError& error) {
    BOOST_TEST(std::string(error.what()).find("unstable at this speed") != std::string::npos);
    return true;
  }
  return false;
}

// z'' + 2 (zeta omega + i Omega) z' + (omega^2 - Omega^2) z = 0 for z = x + i y in the frame that turns.
BOOST_AUTO_TEST_CASE(damping_that_turns_makes_planets_whirl) {
  annulus::test::Verification record(
      "Growth of planets on damped bearings of a fast carrier",
      "closed form of a mass whose damper turns with it: stable below the speed sqrt(k/m)");
  for (const double speed : {400.0, 990.0, 1100.0, 3000.0}) {
    const std::complex<double> half(zeta * omega, speed);
    const auto root = std::sqrt(half * half - (omega * omega - speed * speed));
    const auto first = -half + root, second = -half - root;
    const auto expected = first.real() > second.real() ? first : second;
    const auto system = assemble(planets_alone(2 * omega * omega, speed));
    const auto found = fastest_growth(system);
    BOOST_TEST(refused(system) == (speed > omega));
    if (speed < omega) {  // the turning of the planets, hardly held by their meshes, dies out last
      BOOST_TEST(expected.real() < 0);
      BOOST_TEST(std::abs(found.rate) < 1e-6);
      continue;
    }
    const char* origin = "meshes of 1e-3 N/m shift 5e-7 rad/s";
    record.near("rate of growth", "1/s", found.rate, expected.real(), 1e-6, origin);
    record.near("frequency", "rad/s", 2 * std::numbers::pi * found.frequency, std::abs(expected.imag()), 1e-6, origin);
    BOOST_TEST((found.dof.ends_with("_x") || found.dof.ends_with("_y")), found.dof);
  }
}

BOOST_AUTO_TEST_CASE(planets_softer_than_their_centrifugal_force_fly_out) {
  annulus::test::Verification record("Planets that can move outwards alone, on bearings of a fast carrier",
                                     "closed form: m x'' + c x' + (k - m Omega^2) x = 0");
  for (const double speed : {900.0, 1100.0}) {
    const double stiffening = speed * speed - omega * omega;
    const std::complex<double> root = std::sqrt(std::complex<double>(std::pow(zeta * omega, 2) + stiffening));
    const auto expected = -zeta * omega + root;
    const auto system = assemble(planets_alone(rigid, speed));
    const auto found = fastest_growth(system);
    BOOST_TEST(refused(system) == (speed > omega));
    if (speed < omega) {  // the turning of the planets, hardly held by their meshes, dies out last
      BOOST_TEST(expected.real() < 0);
      BOOST_TEST(std::abs(found.rate) < 1e-6);
      continue;
    }
    const char* origin = "meshes of 1e-3 N/m shift 5e-7 rad/s";
    record.near("rate of growth", "1/s", found.rate, expected.real(), 1e-6, origin);
    record.near("frequency", "rad/s", 2 * std::numbers::pi * found.frequency, std::abs(expected.imag()), 1e-6, origin);
    BOOST_TEST(found.dof.ends_with("_x"), found.dof);
  }
}

// Rigid motions neither grow nor shrink; rounding must not make them grow.
BOOST_AUTO_TEST_CASE(stages_that_turn_freely_are_not_refused) {
  auto stage = stages::ring_paper();
  BOOST_CHECK_NO_THROW(refuse_growth(assemble(stage), 1e-3));
  stage.mesh_damping_ratio = stage.support_damping_ratio = 0;
  BOOST_CHECK_NO_THROW(refuse_growth(assemble(stage), 1e-3));
}

// The meshes hold a sun that floats alone. Of two bodies that float neither holds the other: the planets roll.
BOOST_AUTO_TEST_CASE(one_body_may_float) {
  auto stage = stages::ring_paper();
  stage.sun.support = 0;
  BOOST_TEST(!refused(assemble(stage)));
  stage.ring.support = 0;
  BOOST_TEST(refused(assemble(stage)));
}

void no_steady_state(const PlanetaryStage& stage) {
  BOOST_CHECK_EXCEPTION((void)simulate(stage, SimulationOptions{}), InputError, [](const InputError& error) {
    return std::string(error.what()).find("unstable at this speed") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(a_stage_that_flies_apart_has_no_steady_state) {
  auto stage = stages::ring_paper();
  const double centrifugal = stage.planet.mass * std::pow(stage.carrier_speed, 2);
  stage.planet_bearings = {{0.5 * centrifugal, 0.5 * centrifugal}};
  no_steady_state(stage);
  // Friction follows the mesh forces and holds no planet.
  const geometry::GearPair sun(geometry::test::paper_planet(), geometry::test::paper_sun(),
                               geometry::test::paper_centre_distance);
  stage.sun_friction = FlankFriction{0.05, sliding_of(sun, even_shares(sun))};
  no_steady_state(stage);
}

BOOST_AUTO_TEST_SUITE_END()
