#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/planetary/bearing_forces.h"
#include "dynamics/systems/planetary/campbell.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/tables.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(planetary_power_flow)

using namespace annulus::dynamics;
using annulus::geometry::StageMember;

struct Flow {
  const char* name;
  std::optional<StageMember> held;
  double carrier, ring;  ///< speeds in those of the carrier of the stage with a fixed ring
};

/// The same rolling of the teeth with each member held, with none held, and with the flow of power turned round.
const Flow flows[] = {{"ring held", StageMember::ring, 1, 0},
                      {"carrier held", StageMember::carrier, 0, -1},
                      {"sun held", StageMember::sun, -162.0 / 48, -1 - 162.0 / 48},
                      {"differential", std::nullopt, 1.3, 0.3},
                      {"ring held, carrier drives", StageMember::ring, -1, 0}};

PlanetaryStage with(PlanetaryStage stage, const Flow& flow) {
  const double speed = stage.carrier_speed;
  stage.held = flow.held;
  stage.carrier_speed = flow.carrier * speed;
  stage.ring_speed = flow.ring * speed;
  stage.sun.torsional_support = stage.ring.torsional_support = stage.carrier.torsional_support = 0;
  if (flow.held == StageMember::sun) stage.sun.torsional_support = 1e10;
  if (flow.held == StageMember::ring) stage.ring.torsional_support = 1e10;
  if (flow.held == StageMember::carrier) stage.carrier.torsional_support = 1e10;
  return stage;
}

BOOST_AUTO_TEST_CASE(statics_do_not_depend_on_which_member_is_held) {
  annulus::test::Verification record(
      "Mesh forces of a stage with each of its members held",
      "statics: the moments of the mesh forces equal the torques, which are as z_s : z_r : -(z_s + z_r). The forces "
      "are "
      "those of the stage with a fixed ring, in reversed order where the teeth roll backwards");
  const auto paper = stages::ring_paper();
  const auto fixed = quasi_static(with(paper, flows[0]), 4);
  const Eigen::Index positions = fixed.sun_force.cols();
  BOOST_REQUIRE(positions == 55 * 4);
  const double mean = paper.mean_mesh_force();
  for (const auto& flow : flows) {
    const auto stage = with(paper, flow);
    BOOST_TEST(std::abs(stage.mesh_frequency() / paper.mesh_frequency() - 1) < 1e-12, flow.name);
    const auto found = quasi_static(stage, 4);
    BOOST_REQUIRE(found.sun_force.cols() == positions);
    const bool backwards = stage.mesh_rate() < 0;
    for (Eigen::Index i = 0; i < positions; ++i) {
      const Eigen::Index other = backwards ? (positions - i) % positions : i;
      for (int n = 0; n < 5; ++n) {
        record.near("sun mesh force", "N", found.sun_force(n, i), fixed.sun_force(n, other), 1e-8 * mean,
                    "condition of a direct solve");
        record.near("ring mesh force", "N", found.ring_force(n, i), fixed.ring_force(n, other), 1e-8 * mean,
                    "condition of a direct solve");
      }
      record.near("moment of the sun meshes", "N m", found.sun_force.col(i).sum() * stage.sun.radius, stage.sun_torque,
                  1e-8 * stage.sun_torque, "condition of a direct solve");
      record.near("moment of the ring meshes", "N m", found.ring_force.col(i).sum() * stage.ring.radius,
                  stage.sun_torque * 162 / 48, 1e-8 * stage.sun_torque, "condition of a direct solve");
    }
  }
}

BOOST_AUTO_TEST_CASE(the_held_member_bears_its_torque) {
  annulus::test::Verification record("Torque on the housing in a vibrating stage",
                                     "statics: the mean torque of the held member is the negative of its share of the "
                                     "torques z_s : z_r : -(z_s + z_r)");
  for (const auto& flow : flows) {
    if (!flow.held) continue;
    const auto stage = with(stages::ring_paper(), flow);
    SimulationOptions options;
    options.samples_per_cycle = 32;
    options.confirmation = Confirmation::never;
    options.estimate_error = false;
    const auto response = simulate(stage, options);
    const double share = *flow.held == StageMember::sun    ? 1
                         : *flow.held == StageMember::ring ? 162.0 / 48
                                                           : -210.0 / 48;
    record.close("mean torque of the held member", "N m",
                 support_reaction(stage, response.series, *flow.held).torque.mean(), -share * stage.sun_torque, 2e-3,
                 "peaks of 32 samples per mesh cycle");
    BOOST_TEST(response.force_balance_relative < 2e-3, flow.name);
  }
}

// Without damping and rotating frame the equations of motion are the same forwards and backwards in time.
BOOST_AUTO_TEST_CASE(an_undamped_stage_that_rolls_backwards_moves_backwards) {
  annulus::test::Verification record("A stage that rolls backwards",
                                     "reversal of time: without damping, and with the carrier held, the motion is that "
                                     "of the stage rolling forwards, backwards in time");
  const tables::BentTable bent{.ripple = 0.05};
  const auto compare = [&](PlanetaryStage stage, auto motion, const std::string& what, double tolerance,
                           const char* origin) {
    stage = with(stage, flows[1]);  // the carrier held
    stage.mesh_damping_ratio = stage.support_damping_ratio = 0;
    stage.set_half_backlash(std::nullopt);
    const Eigen::MatrixXd forwards = motion(stage);
    stage.ring_speed = -stage.ring_speed;
    BOOST_TEST(stage.mesh_rate() < 0);
    const Eigen::MatrixXd backwards = motion(stage);
    const Eigen::Index samples = forwards.cols();
    BOOST_REQUIRE(backwards.cols() == samples);
    double largest = 0;
    for (Eigen::Index i = 0; i < samples; ++i)
      largest = std::max(largest, (forwards.col(i) - backwards.col((samples - i) % samples)).cwiseAbs().maxCoeff());
    record.at_most("difference of the mesh forces, " + what + ", over their mean", "",
                   largest / stage.mean_mesh_force(), tolerance, origin);
    BOOST_TEST(forwards.maxCoeff() > 1.02 * stage.mean_mesh_force(), what);  // they vibrate
  };
  const auto balanced = [](const PlanetaryStage& stage) { return periodic_response(stage).force; };
  const auto exact = [](const PlanetaryStage& stage) { return piecewise_response(stage).force; };
  auto stage = stages::ring_paper();
  stage.sun_mesh = HarmonicStiffness{1.364e9, 0.05, 0.13};
  stage.ring_mesh = table_stiffness(bent.table(), stage.mean_mesh_force(), 0.2, LoadDependence::table);
  compare(stage, balanced, "a wave and a table", 1e-5, "convergence of the harmonic balance");
  auto jumps = stages::backlash_paper();
  // No jump falls on a sample.
  jumps.sun_mesh = RectangularStiffness{4.5e8, 0.35, 0.6, 0.013};
  jumps.ring_mesh = RectangularStiffness{5.5e8, 0.25, 0.3, 0.1};
  compare(jumps, exact, "rectangular waves", 1e-6, "exact solution between the jumps");
}

BOOST_AUTO_TEST_CASE(a_wave_that_runs_backwards_jumps_where_it_jumps_forwards) {
  auto stage = stages::backlash_paper();
  stage.ring_mesh = RectangularStiffness{5.5e8, 0.25, 0.3, 0.1};
  const auto forwards = assemble(stage);
  stage.carrier_speed = -stage.carrier_speed;
  const auto backwards = assemble(stage);
  const double period = 1 / stage.mesh_frequency();
  std::vector<double> there, back;
  for (double t = forwards.next_jump(0); t < period * (1 + 1e-9); t = forwards.next_jump(t)) there.push_back(t);
  for (double t = backwards.next_jump(0); t < period * (1 + 1e-9); t = backwards.next_jump(t))
    back.push_back(period - t);
  std::vector<double> expected;
  for (const double t : there) expected.push_back(std::fmod(t + 1e-9 * period, period));
  for (double& t : back) t = std::fmod(t + period + 1e-9 * period, period);
  std::sort(expected.begin(), expected.end());
  std::sort(back.begin(), back.end());
  BOOST_REQUIRE(back.size() == expected.size());
  BOOST_TEST(back.size() == 12U);  // two for each of six meshes
  for (std::size_t i = 0; i < back.size(); ++i) BOOST_TEST(std::abs(back[i] - expected[i]) < 1e-8 * period);
}

// A differential has two rigid motions: all members turn together, and the teeth roll.
BOOST_AUTO_TEST_CASE(free_members_turn_without_energy) {
  for (const auto& flow : flows) {
    const auto found = annulus::dynamics::modes(with(stages::ring_paper(), flow)).modes;
    const auto rigid_motions =
        std::count_if(found.begin(), found.end(), [](const Mode& mode) { return mode.frequency == 0; });
    BOOST_TEST(rigid_motions == (flow.held ? 1 : 2), flow.name);
  }
}

BOOST_AUTO_TEST_CASE(errors_turn_with_their_bodies) {
  auto stage = with(stages::ring_paper(), flows[3]);
  stage.sun.errors = stage.ring.errors = stage.carrier.errors = {{1e-5, 0.1}, {2e-5, 0.2}};
  const double rolling = stage.carrier_speed - stage.ring_speed;
  const double sun = annulus::geometry::member_speeds(48, 162, {StageMember::carrier, stage.carrier_speed},
                                                      {StageMember::ring, stage.ring_speed})[StageMember::sun];
  const auto rate_of = [](const std::vector<HarmonicError>& errors, std::size_t i) { return errors.at(i).rate; };
  const auto near = boost::test_tools::tolerance(1e-12);
  const auto of_sun = sun_mesh_errors(stage, 1), of_ring = ring_mesh_errors(stage, 1);
  BOOST_TEST(rate_of(of_sun, 0) == -rolling * 162 / 55, near);  // eccentric planet
  BOOST_TEST(rate_of(of_sun, 2) == sun - stage.carrier_speed, near);
  BOOST_TEST(rate_of(of_sun, 3) == -stage.carrier_speed, near);  // fixed in the housing
  BOOST_TEST(rate_of(of_ring, 2) == stage.ring_speed - stage.carrier_speed, near);
  BOOST_TEST(rate_of(of_ring, 3) == -stage.carrier_speed, near);
}

BOOST_AUTO_TEST_CASE(periods_of_what_is_fixed_in_the_housing) {
  auto stage = stages::ring_paper();
  stage.planet_errors.clear();
  stage.carrier.errors.position = {1e-5, 0};
  const auto period = [&](const Flow& flow) { return with(stage, flow).error_period(); };
  BOOST_TEST(period(flows[0]) == 162);
  BOOST_TEST(period(flows[1]) == 1);   // the housing stands still against the carrier
  BOOST_TEST(period(flows[2]) == 48);  // it turns as the sun does
  BOOST_TEST(period({"carrier at twice the speed of the ring", std::nullopt, 2, 1}) == 81);
  BOOST_TEST(period({"no common period", std::nullopt, 1, std::sqrt(0.5)}) == PlanetaryStage::never_repeats);
  stage.carrier.errors = {};
  stage.ring.errors.eccentricity = {1e-5, 0};
  for (const auto& flow : flows) BOOST_TEST(period(flow) == 162, flow.name);
}

BOOST_AUTO_TEST_CASE(critical_speeds_do_not_depend_on_the_direction) {
  const auto forwards = stages::ring_paper();
  auto backwards = forwards;
  backwards.carrier_speed = -forwards.carrier_speed;
  std::vector<double> speeds;
  for (int i = 0; i <= 20; ++i) speeds.push_back(3.0 * i);
  const auto there = campbell(forwards, speeds), back = campbell(backwards, speeds);
  BOOST_REQUIRE(there.crossings.size() == back.crossings.size());
  BOOST_TEST(there.crossings.size() > 10U);
  for (std::size_t i = 0; i < there.crossings.size(); ++i) {
    BOOST_TEST(there.crossings[i].speed == back.crossings[i].speed, boost::test_tools::tolerance(1e-7));
    BOOST_TEST(std::abs(there.crossings[i].participation - back.crossings[i].participation) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(refusals_say_what_to_change) {
  const auto refused = [](const PlanetaryStage& stage, const std::string& words) {
    BOOST_CHECK_EXCEPTION((void)assemble(stage), annulus::InputError, [&](const auto& error) {
      return std::string(error.what()).find(words) != std::string::npos;
    });
  };
  auto stage = with(stages::ring_paper(), flows[3]);
  stage.carrier.torsional_support = rigid;
  refused(stage, "the carrier cannot turn");
  auto held = with(stages::ring_paper(), flows[1]);
  held.carrier_speed = 3;
  refused(held, "the carrier is held and turns at 3 rad/s");
  auto still = stages::ring_paper();
  still.ring_speed = still.carrier_speed;
  BOOST_CHECK_THROW((void)simulate(still), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
