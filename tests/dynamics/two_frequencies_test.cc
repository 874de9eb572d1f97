#include "dynamics/steady_state/two_frequencies.h"

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>
#include <vector>

#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/periodic_response.h"
#include "dynamics/steady_state/quasi_static_forces.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

/// Motions over two angles.
BOOST_AUTO_TEST_SUITE(two_frequencies)

using namespace annulus;
using namespace annulus::dynamics;
using annulus::test::Verification;

namespace {

/// A ring mesh whose stiffness repeats after so many teeth: 27 on 24 pins around 162 teeth.
/// `law`: the stiffness rises with the load, from half of it to twice, by a tenth each way.
TableStiffness on_pins(double load, double wave, int positions = 27, LoadDependence law = LoadDependence::nominal) {
  constexpr int phases = 16;
  const bool rises = law == LoadDependence::table;
  const std::vector<double> loads = rises ? std::vector{load / 2, load, 2 * load} : std::vector{load};
  std::vector<StiffnessEntry> entries;
  std::vector<double> angles;
  for (int p = 0; p < positions; ++p) {
    angles.push_back(2 * std::numbers::pi * p / 162);
    for (int i = 0; i < phases; ++i) {
      const double cycles = p + static_cast<double>(i) / phases;
      const double k = 1.87e9 * (1 + 0.0647 * std::cos(2 * std::numbers::pi * cycles) +
                                 wave * std::cos(2 * std::numbers::pi * 4 * cycles / positions));
      for (const double at : loads) {
        StiffnessEntry entry;
        const double power = rises ? std::log(1.1) / std::log(2.0) : 0;  // k ~ F^power
        const double secant = k * std::pow(at / load, power);
        entry.unloaded_te = 2e-6 * std::sin(2 * std::numbers::pi * 4 * cycles / positions);
        entry.lte = at / secant + entry.unloaded_te;
        entry.stiffness_secant = secant;
        entry.stiffness_tangent = secant / (1 - power);
        entries.push_back(entry);
      }
    }
  }
  return table_stiffness(StiffnessTable("ring_planet", phases, angles, loads, entries), load, 0, law);
}

PlanetaryStage on_24_pins() {
  auto stage = stages::ring_paper();
  stage.ring_mesh = on_pins(stage.mean_mesh_force(), 0.02);
  stage.ring_tooth_offset = {0, 5, 11, 16, 22};
  return stage;
}

/// Teeth separate often: forces are not smooth in the second angle.
PlanetaryStage with_loss_of_contact(int positions, double load = 0.35) {
  auto stage = stages::ring_paper();
  stage.ring_mesh = on_pins(stage.mean_mesh_force(), 0.02, positions);
  for (auto& errors : stage.planet_errors) errors.eccentricity.amount *= 3;
  stage.sun_torque *= load;
  return stage;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

BOOST_AUTO_TEST_CASE(angles_of_excitations) {
  const auto angles_of = [](const PlanetaryStage& stage) {
    return dynamics::two_frequencies(assemble(stage), stage.mesh_frequency(), stage.error_period());
  };
  const auto pins = on_24_pins();
  BOOST_TEST(pins.error_period() == 27 * 55);
  const auto found = angles_of(pins);
  BOOST_REQUIRE(found);
  BOOST_TEST(found->cycles == 27);
  BOOST_TEST(std::abs(found->second_rate - 2 * std::numbers::pi * pins.mesh_frequency() / 55) < 1e-9);
  BOOST_TEST(found->waves.size() == 10U);
  // Errors that repeat with the first angle belong to it, and only what saves time is worth a second one.
  auto ring = pins;
  ring.ring.errors.eccentricity = {20e-6, 0};
  BOOST_REQUIRE(angles_of(ring));
  BOOST_TEST(angles_of(ring)->cycles == 162);
  auto none = pins;
  none.planet_errors.clear();
  BOOST_TEST(!angles_of(none));
  auto reduced = without_waves(assemble(pins), found->waves);
  for (const auto& mesh : reduced.meshes())
    for (const auto& error : mesh.errors) BOOST_TEST(error.rate == 0);
}

/// A motion over two angles and over its whole period, with 16 samples per mesh cycle.
struct BothWays {
  PeriodicResponse over_angles, over_period;
  double seconds_over_angles = 0, seconds_over_period = 0;

  /// `tolerance`: of the samples, over the mean mesh force.
  BothWays(const PlanetaryStage& stage, double tolerance) {
    const auto system = assemble(stage);
    const int cycles = stage.error_period();
    const double period = cycles / stage.mesh_frequency();
    PeriodicOptions options;
    options.samples_per_cycle = options.max_samples_per_cycle = options.max_samples_ahead = 16;
    options.sampling_tolerance = tolerance * stage.mean_mesh_force();
    const auto angles = dynamics::two_frequencies(system, stage.mesh_frequency(), cycles);
    BOOST_REQUIRE(angles);
    seconds_over_angles =
        seconds_of([&] { over_angles = two_frequency_response(system, *angles, period, cycles, options); });
    seconds_over_period = seconds_of([&] { over_period = periodic_response(system, period, cycles, options); });
  }
};

// The motion over both angles is that over the whole period of 1485 mesh cycles.
BOOST_AUTO_TEST_CASE(pins_and_planet_errors) {
  Verification record("Motion over two angles", "harmonic balance over the common period");
  const auto stage = on_24_pins();
  const BothWays found(stage, 1e-3);
  const auto &over_angles = found.over_angles, &over_period = found.over_period;
  BOOST_TEST_MESSAGE("two angles: " << found.seconds_over_angles << " s, whole period: " << found.seconds_over_period
                                    << " s");
  BOOST_TEST_REQUIRE(over_angles.converged, over_angles.trouble);
  BOOST_TEST_REQUIRE(over_period.converged, over_period.trouble);
  BOOST_TEST(over_angles.open.maxCoeff() == 0);
  const double scale = stage.mean_mesh_force();
  record.at_most("mesh force, largest difference over the mean force", "",
                 (over_angles.force - over_period.force).cwiseAbs().maxCoeff() / scale, 1e-3,
                 "values of the second angle");
  for (const auto& [values, expected, what] :
       {std::tuple{&over_angles.displacement, &over_period.displacement,
                   "displacement, largest difference over the largest one"},
        {&over_angles.velocity, &over_period.velocity, "velocity, largest difference over the largest one"}})
    record.at_most(what, "", (*values - *expected).cwiseAbs().maxCoeff() / expected->cwiseAbs().maxCoeff(), 1e-3,
                   "values of the second angle");
  // It says no smaller error than it has.
  BOOST_TEST((over_angles.force - over_period.force).cwiseAbs().maxCoeff() <=
             over_angles.largest_difference() + over_period.largest_difference());
}

// Where teeth separate often, forces are not smooth in the second angle: the whole period has a solution alone.
BOOST_AUTO_TEST_CASE(loss_of_contact) {
  const BothWays found(with_loss_of_contact(3), 1e-2);
  BOOST_TEST(!found.over_angles.converged);
  BOOST_TEST(!found.over_angles.trouble.empty());
  BOOST_TEST(found.over_period.converged);
  BOOST_TEST(found.over_period.open.maxCoeff() > 0);
}

// Equilibria at few values of the second angle stand for those of all mesh cycles: exactly where meshes are linear,
// within the limit where they stiffen with the load, and where teeth separate.
BOOST_AUTO_TEST_CASE(equilibria_over_two_angles) {
  Verification record("Static equilibria over two angles", "an equilibrium at every position");
  auto stiffening = on_24_pins();
  stiffening.ring_mesh = on_pins(stiffening.mean_mesh_force(), 0.02, 27, LoadDependence::table);
  for (const auto& [name, stage, limit, origin] :
       {std::tuple{"linear meshes", on_24_pins(), 1e-11, "rounding"},
        {"meshes that stiffen with the load", stiffening, 1e-4, "limit at the positions that are compared"},
        {"loss of contact", with_loss_of_contact(27, 0.25), 1e-4, "limit at the positions that are compared"}}) {
    const auto system = assemble(stage);
    const int cycles = stage.error_period(), positions = 8;
    Eigen::MatrixXd over_angles, at_every_position;
    const double seconds =
        seconds_of([&] { over_angles = quasi_static_forces(system, stage.mesh_frequency(), cycles, positions); });
    const double seconds_at_every_position = seconds_of([&] {
      at_every_position =
          static_path(system, Eigen::VectorXd::LinSpaced(cycles * positions, 0, cycles * positions - 1) /
                                  (positions * stage.mesh_frequency()))
              .force;
    });
    BOOST_TEST_MESSAGE(name << ": two angles " << seconds << " s, every position " << seconds_at_every_position
                            << " s");
    BOOST_REQUIRE(over_angles.cols() == at_every_position.cols());
    BOOST_TEST((at_every_position.minCoeff() == 0) == (std::string(name) == "loss of contact"));
    record.at_most(std::string("mesh force, largest difference over the largest one: ") + name, "",
                   (over_angles - at_every_position).cwiseAbs().maxCoeff() / at_every_position.cwiseAbs().maxCoeff(),
                   limit, origin);
  }
}

BOOST_AUTO_TEST_CASE(steady_response_over_two_angles) {
  const auto stage = on_24_pins();
  SimulationOptions options;
  options.samples_per_cycle = 32;
  options.other_motions.starts = 0;
  const auto found = simulate(stage, options);
  BOOST_TEST(found.steady);
  BOOST_TEST(found.confirmed);
  BOOST_REQUIRE(found.periodic);
  BOOST_TEST((found.periodic->method == PeriodicMethod::two_frequencies));
  BOOST_TEST(found.periodic->longer_angle == 55);
  BOOST_TEST(found.window_cycles == 27 * 55);
  BOOST_TEST(found.series.time.size() == 27 * 55 * 32);
}

BOOST_AUTO_TEST_SUITE_END()
