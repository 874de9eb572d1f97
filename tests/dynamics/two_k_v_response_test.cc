#include "dynamics/systems/two_k_v/two_k_v_response.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(two_k_v_response)

using namespace annulus::dynamics;

TwoKVStage running(double output_speed) {
  auto stage = stages::reducer();
  stage.sun_mesh = HarmonicStiffness{1.4e8, 0.15, 0};
  stage.arc_mesh = HarmonicStiffness{7.5e8, 0.05, 0.2};
  stage.mesh_damping_ratio = 0.05;
  stage.support_damping_ratio = 0.05;
  stage.output_speed = output_speed;
  return stage;
}

BOOST_AUTO_TEST_CASE(periodic_state_at_nominal_speed) {
  annulus::test::Verification record("Periodic state of the 2K-V reducer at nominal speed",
                                     "balances of torque and energy; wind-up -T/k averaged over the crank angle");
  const auto stage = running(stages::reducer().output_speed);
  const auto response = simulate(stage);
  BOOST_TEST(response.steady);
  BOOST_TEST(response.crank_turns == 1);
  // Balances are met to the accuracy of the integrator (1e-6) and of the steady state (1e-3 of the force, whose drift
  // counts in full here).
  BOOST_REQUIRE(response.torque_balance_relative.has_value());
  const char* origin = "integrator 1e-6, steady state 1e-3 of the force";
  record.at_most("torque balance, relative", "", *response.torque_balance_relative, 1e-4, origin);
  record.at_most("energy balance, relative", "", response.energy.relative, 1e-4, origin);
  for (const auto& mesh : response.arc_pins)
    record.near("mean arc mesh force over that of statics", "", mesh.mean_force / response.mean_arc_force, 1, 2e-3,
                origin);
  // The wind-up under 58 N m, -T/k: the mean over the crank angle at frozen stiffness.
  const auto stiffness = torsional_stiffness(stage, 64);
  const double expected = -58 * stiffness.from_output.cwiseInverse().mean();
  record.near("mean quasi-static wind-up", "rad", response.quasi_static.mean, expected, 1e-3 * std::abs(expected),
              origin);
  record.near("mean dynamic wind-up", "rad", response.dynamic.mean, expected, 2e-3 * std::abs(expected), origin);
  // Both meshes have whole numbers of cycles in a crank turn: their orders stand out.
  const auto& lines = response.error_spectrum;
  double mesh_lines = 0, largest = 0;
  for (Eigen::Index i = 1; i < lines.order.size(); ++i) {
    largest = std::max(largest, lines.amplitude[i]);
    if (i == 34 || i == 29) mesh_lines = std::max(mesh_lines, lines.amplitude[i]);
  }
  BOOST_TEST(mesh_lines == largest);
}

// At a crawl inertia does nothing: the dynamic error follows the static one.
BOOST_AUTO_TEST_CASE(slow_motion_is_quasi_static) {
  annulus::test::Verification record("The 2K-V reducer at a crawl", "limit: the quasi-static transmission error");
  SimulationOptions options;
  options.samples_per_cycle = 16;  // as the static positions
  options.mesh_cycles = 34;        // from the equilibrium on
  options.estimate_error = false;
  options.integrator.relative_tolerance = 1e-6;
  const auto response = simulate(running(0.05), options);
  BOOST_REQUIRE(response.dynamic.series.size() == response.quasi_static.series.size());
  const double swing = response.quasi_static.peak_to_peak.value;
  // (mesh frequency 8 Hz / 131 Hz)^2 = 0.4 % of the swing, and damping.
  record.at_most("largest difference over the swing", "",
                 (response.dynamic.series - response.quasi_static.series).cwiseAbs().maxCoeff() / swing, 2e-2,
                 "(8 Hz / 131 Hz)^2 = 0.4 %, and damping");
}

// Free at both ends the first elastic mode is at 1893 Hz: meshing at 162 Hz is slow.
BOOST_AUTO_TEST_CASE(both_ends_free_give_the_same_mesh_forces) {
  annulus::test::Verification record("A 2K-V reducer free at both ends", "statics: mesh forces from the ratio");
  auto stage = running(1);
  stage.output_support = 0;
  SimulationOptions options;
  options.samples_per_cycle = 16;
  options.mesh_cycles = 34;
  options.estimate_error = false;
  const auto response = simulate(stage, options);
  for (const auto& mesh : response.sun_planet) {
    record.near("mean sun mesh force over that of statics", "", mesh.mean_force / response.mean_sun_force, 1, 5e-3,
                "steady state 1e-3, first mode twelve times above the mesh frequency");
    BOOST_TEST(mesh.contact_loss.value == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  BOOST_CHECK_THROW((void)simulate(running(0)), annulus::InputError);
  auto stage = running(1);
  stage.output_torque = 0;
  BOOST_CHECK_THROW((void)simulate(stage), annulus::InputError);
  stage = running(1);
  stage.input_support = rigid;
  BOOST_CHECK_THROW((void)simulate(stage), annulus::InputError);
  // Shooting takes the fixed steps as well.
  SimulationOptions options;
  options.integrator.method = Integrator::runge_kutta_4;
  options.integrator.fixed_step = 1 / running(1).sun_mesh_frequency();
  BOOST_CHECK_THROW((void)simulate(running(1), options), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(period) {
  annulus::test::Verification record("Period of the 2K-V reducer",
                                     "counted by hand: both meshes have whole numbers of cycles in a crank turn");
  record.near("period", "crank turns", period_in_crank_turns(stages::reducer()), 1, 0, "exact");
}

BOOST_AUTO_TEST_SUITE_END()
