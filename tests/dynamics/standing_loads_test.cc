#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/planetary/space_motion.h"
#include "tests/dynamics/lumped_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(standing_loads)

using namespace annulus::dynamics;
using namespace stages::lumped_in_space;
namespace units = annulus::units;
using Eigen::Vector3d;

/// Weight and a rotor's loads in the housing, on a stage that turns slowly past them.
SpatialStage loaded_in_housing(double speed) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  s.plane.carrier_speed = speed;
  s.gravity = {2, -9.5, 1};
  s.weights = {{{Kind::sun}, 180, 0.1}, {{Kind::ring}, 509, 0}, {{Kind::carrier}, 1500, -0.05}};
  for (int n = 0; n < 3; ++n) s.weights.push_back({{Kind::planet, n}, 110, 0.01});
  add_all_bearings(s);
  s.loads = {{"rotor", {Kind::carrier}, StageFrame::housing, {0.1, 0, -0.5}, {2e4, -3e4, 4e4}, {5e4, 2e4, 0}},
             {"pin", {Kind::planet, 1}, StageFrame::planet, {0.02, 0, 0.05}, {1e3, 0, -1e3}, {50, 70, 0}}};
  return s;
}

// What stands in the housing turns past the carrier: at every angle the forces are those of the statics there.
BOOST_AUTO_TEST_CASE(standing_loads_are_those_of_the_statics_at_every_angle) {
  annulus::test::Verification record("Standing loads of a lumped stage in space", "statics of the mechanism");
  const std::vector<double> cycles{0, 13, 41, 77};
  // With a pin beside its place a carrier in clearance does not stand still in the housing.
  enum class Case { linear, clearance, clearance_and_error, planets_on_rollers, rollers_on_carrier, mounts };
  for (const auto which : {Case::linear, Case::clearance, Case::clearance_and_error, Case::planets_on_rollers,
                           Case::rollers_on_carrier, Case::mounts}) {
    constexpr double speed = 1e-3;  // no centrifugal forces to speak of
    auto s = loaded_in_housing(speed);
    if (which != Case::clearance) {
      s.plane.planet_errors.assign(3, {});
      s.plane.planet_errors[1].position = {60e-6, 0.7};
    }
    if (which == Case::clearance || which == Case::clearance_and_error) {
      s.loads.pop_back();
      s.bearings[6].play = 150e-6;
      s.bearings[7].play = 100e-6;
    }
    if (which == Case::rollers_on_carrier) s.pins = pins_stiffness(stages::two_wall_carrier(s));
    if (which == Case::planets_on_rollers || which == Case::rollers_on_carrier)
      for (std::size_t i = 0; i < 6; ++i) s.bearings[i].row = stages::row_of_planets();
    if (which == Case::mounts) stages::put_ring_in_mounts(s, 4);
    const bool wanders = which == Case::clearance_and_error;
    const char* origin = wanders ? "residual of the equilibria; the contact of a face ends between two of its places"
                                 : "residual of the equilibria";
    const double tolerance = wanders ? 1e-5 : 1e-8;
    const auto expected = statics(s, cycles);
    auto stage = lumped(s);
    stage.space->laws = BearingLaws::whole;
    stage.rotating_frame = false;
    BOOST_TEST(stage.error_period() == 99);
    double change = 0;
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      const auto found = solved(stage, cycles[i] / stage.mesh_frequency());
      for (std::size_t m = 0; m < 6; ++m) {
        const auto& mesh = m < 3 ? expected.positions[i].sun_meshes[m] : expected.positions[i].ring_meshes[m - 3];
        const auto& first = m < 3 ? expected.positions[0].sun_meshes[m] : expected.positions[0].ring_meshes[m - 3];
        const double half = (m < 3 ? sun_width : ring_width) / 2;
        const auto name = wanders                             ? ", a carrier in clearance that wanders"
                          : which == Case::planets_on_rollers ? ", planets on rollers"
                          : which == Case::rollers_on_carrier ? ", planets on rollers on a carrier that gives way"
                          : which == Case::mounts             ? ", a ring in four mounts beside its axis"
                                                              : "";
        record.close(std::string("mesh forces") + name, "N", found.force[m], mesh.force, tolerance, origin);
        record.at_most(std::string("moment along the face over force x half its width") + name, "",
                       std::abs(found.tilt[m] * half - mesh.force * mesh.place) / (half * mesh.force), tolerance,
                       origin);
        change = std::max(change, std::abs(mesh.force * mesh.place - first.force * first.place) / (half * mesh.force));
      }
    }
    BOOST_TEST(change > 0.02, change);  // the turn matters
  }
}

// Harmonic balance and time integration of a stage that turns past its loads, and the forces in its bearings.
BOOST_AUTO_TEST_CASE(response_to_standing_loads_by_two_methods) {
  annulus::test::Verification record("Response to standing loads", "time integration, balance of energy, reactions");
  for (const bool loose : {false, true}) {
    auto s = loaded_in_housing(120 * units::rpm);
    s.loads.pop_back();
    if (loose) {
      for (std::size_t i = 0; i < 6; ++i) s.bearings[i].row = stages::row_of_planets();
      s.bearings[6].axial_play = 20e-6;
    }
    const std::string with = loose ? ", rollers and axial clearance" : "";
    auto stage = lumped(s);
    stage.space->laws = BearingLaws::whole;
    const double c2 = std::pow(std::cos(s.base_helix_angle), 2);
    stage.sun_mesh = HarmonicStiffness{sun_stiffness * c2, 0.1, 0};
    stage.mesh_damping_ratio = 0.05;
    stage.support_damping_ratio = 0.04;
    SimulationOptions options;
    options.samples_per_cycle = 32;
    options.integrator.relative_tolerance = 1e-7;
    options.keep_series = true;
    options.confirmation = Confirmation::always;
    const auto found = simulate(stage, options);
    BOOST_TEST(found.confirmed);
    BOOST_TEST(found.window_cycles == 99);
    record.at_most("difference of harmonic balance and time integration, of the mean force" + with, "",
                   *found.steady_difference, 1e-3, "tolerance of the steady state");
    record.at_most("balance of energy" + with, "", found.energy.relative, 1e-4, "tolerance of the integrator");
    record.at_most("balance of the sun's torque" + with, "", found.force_balance_relative, 1e-4,
                   "tolerance of the integrator");
    // In the mean over a turn the housing bears what stands in it.
    const auto motion = space_motion(stage, found.series);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::ArrayXd angle = stage.carrier_speed * found.series.time.array();
    for (const auto& b : motion.bearings) {
      if (b.on.kind != Kind::housing) continue;
      const Eigen::ArrayXd x = b.force.row(0).transpose(), y = b.force.row(1).transpose();
      sum += Vector3d((angle.cos() * x - angle.sin() * y).mean(), (angle.sin() * x + angle.cos() * y).mean(),
                      b.force.row(2).mean());
    }
    const double mass = 180 + 509 + 1500 + 3 * 110;
    const Vector3d expected = -(mass * s.gravity + Vector3d(2e4, -3e4, 4e4));
    for (Eigen::Index i = 0; i < 3; ++i)
      record.near("mean force of the housing over the load" + with, "", sum[i] / expected.norm(),
                  expected[i] / expected.norm(), 1e-4, "tolerance of the steady state; dampers of bearings");
  }
}

BOOST_AUTO_TEST_SUITE_END()
