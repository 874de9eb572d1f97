#include "dynamics/systems/train/train.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "dynamics/systems/helical_pair/pair_response.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/two_k_v/two_k_v_response.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

/// Gear sets in line.
BOOST_AUTO_TEST_SUITE(trains)

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double tau = 2 * std::numbers::pi;
constexpr double shaft_stiffness = 4e6, shaft_damping = 0.04, motor = 15, motor_shaft = 3e6;

TrainPart part_of(const std::string& name, const HelicalPair& pair) {
  return {name, lumped_case(pair), pair.shaft_ends()};
}

/// The first pair, and one whose pinion turns with its wheel.
std::pair<HelicalPair, HelicalPair> two_pairs() {
  auto first = pairs::held(pairs::error_paper());
  first.mesh = ConstantStiffness{mean_stiffness(first.mesh)};
  first.mesh_error = {130e-6, 0};
  auto second = first;
  second.pinion.teeth = 25;
  second.wheel.teeth = 40;
  second.pinion.radius *= 25.0 / 21;
  second.wheel.radius *= 40.0 / 37;
  second.mesh = ConstantStiffness{0.8 * mean_stiffness(first.mesh)};
  second.mesh_error = {60e-6, 1.1};
  second.pinion_speed = first.wheel_speed();
  second.pinion_torque = first.wheel_torque();
  return {first, second};
}

Train train_of(const HelicalPair& first, const HelicalPair& second) {
  return {{part_of("first", first), part_of("second", second)},
          {{"between", {"first", "wheel"}, {"second", "pinion"}, shaft_stiffness, shaft_damping, 0}},
          {{"motor", "first.pinion", motor, motor_shaft, 0.02}}};
}

/// In angles: motor, pinion and wheel of the first pair, pinion and wheel of the second one. The flanks of a pair
/// approach where both of its gears turn in their positive sense, so that the sense changes from one pair to the next.
struct ByHand {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(5, 5), stiffness = mass, damping = mass;
  std::array<Eigen::VectorXd, 2> mesh{Eigen::VectorXd::Zero(5), Eigen::VectorXd::Zero(5)};
  std::array<double, 2> mesh_stiffness{}, mesh_damping{};
  Eigen::VectorXd twist = Eigen::VectorXd::Zero(5);
  double shaft_c = 0;

  ByHand(const HelicalPair& first, const HelicalPair& second) {
    mass.diagonal() << motor, first.pinion.inertia, first.wheel.inertia, second.pinion.inertia, second.wheel.inertia;
    Eigen::VectorXd motor_twist = Eigen::VectorXd::Zero(5);
    motor_twist[0] = 1;
    motor_twist[1] = -1;
    (void)spring(motor_twist, motor_shaft, 0.02, 0, 1);
    twist[2] = twist[3] = 1;
    shaft_c = spring(twist, shaft_stiffness, shaft_damping, 2, 3);
    for (const int i : {0, 1}) {
      const auto& pair = i == 0 ? first : second;
      const auto m = static_cast<std::size_t>(i);
      const double c = std::cos(pair.base_helix_angle);
      mesh[m][1 + 2 * i] = c * pair.pinion.radius;
      mesh[m][2 + 2 * i] = c * pair.wheel.radius;
      mesh_stiffness[m] = mean_stiffness(pair.mesh);
      mesh_damping[m] = 2 * pair.mesh_damping_ratio * std::sqrt(mesh_stiffness[m] * pair.reduced_mass());
      stiffness += mesh_stiffness[m] * mesh[m] * mesh[m].transpose();
      damping += mesh_damping[m] * mesh[m] * mesh[m].transpose();
    }
  }
  double spring(const Eigen::VectorXd& along, double k, double ratio, int a, int b) {
    const double c = 2 * ratio * std::sqrt(k / (1 / mass(a, a) + 1 / mass(b, b)));
    stiffness += k * along * along.transpose();
    damping += c * along * along.transpose();
    return c;
  }
  /// Torque of the shaft between the pairs by the error of one mesh, as a complex amplitude of exp(i rate t).
  [[nodiscard]] std::complex<double> torque(std::size_t m, const ErrorWave& error, double rate) const {
    using Complex = std::complex<double>;
    const Complex i(0, 1);
    Eigen::MatrixXcd dynamic = (stiffness - rate * rate * mass).cast<Complex>();
    dynamic += i * rate * damping.cast<Complex>();
    // amount sin(rate t + phase)
    const Complex amount = error.amount * std::exp(i * error.phase) / i;
    const Eigen::VectorXcd load = (mesh_stiffness[m] + i * rate * mesh_damping[m]) * amount * mesh[m].cast<Complex>();
    const Eigen::VectorXcd angle = dynamic.partialPivLu().solve(load);
    // In the sense of the loads of both bodies, which are positive.
    return -(shaft_stiffness + i * rate * shaft_c) * (angle[2] + angle[3]);
  }
};

SimulationOptions quick() {
  SimulationOptions options;
  options.other_motions.starts = 0;
  return options;
}

}  // namespace

BOOST_AUTO_TEST_CASE(natural_frequencies) {
  annulus::test::Verification record("Natural frequencies of two pairs in line, with a motor",
                                     "matrices of the five inertias in angles, assembled by hand");
  const auto [first, second] = two_pairs();
  const ByHand train(first, second);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(train.stiffness, train.mass,
                                                                         Eigen::EigenvaluesOnly);
  const auto found = modes(train_of(first, second)).modes;
  BOOST_TEST_REQUIRE(found.size() == 5u);
  BOOST_TEST(found[0].frequency == 0.0);
  for (std::size_t i = 1; i < found.size(); ++i)
    record.close("natural frequency", "Hz", found[i].frequency,
                 std::sqrt(solver.eigenvalues()[static_cast<Eigen::Index>(i)]) / tau, 1e-9, "rounding");
}

// Both meshes have a frequency of their own. Their cycles are 37 to 25: of the faster one, the first, 37 make a period.
BOOST_AUTO_TEST_CASE(the_common_period) {
  const auto [first, second] = two_pairs();
  const auto problem = steady_problem(train_of(first, second));
  BOOST_TEST(problem.mesh_frequency == first.mesh_frequency());
  BOOST_TEST(problem.period_in_cycles == 37);
  auto slower = second;
  slower.pinion.error = {1e-6, 0};  // repeats after 25 cycles of the second mesh, that is a turn: 37 of the first
  BOOST_TEST(steady_problem(train_of(first, slower)).period_in_cycles == 37);
  slower.wheel.error = {1e-6, 0};  // 40 of the second: 59.2 of the first; five times that are 296
  BOOST_TEST(steady_problem(train_of(first, slower)).period_in_cycles == 296);
}

// Constant stiffness: two harmonics, whose frequencies are 37 to 25. The largest sum of both over the common period is
// looked for at 200 places of a cycle.
BOOST_AUTO_TEST_CASE(two_meshes_of_different_frequencies) {
  annulus::test::Verification record("Torque between two pairs in line whose meshes have different frequencies",
                                     "complex amplitudes of five inertias in angles, solved by hand, superposed");
  const auto [first, second] = two_pairs();
  const auto train = train_of(first, second);
  const ByHand hand(first, second);
  const double f1 = first.mesh_frequency(), f2 = second.mesh_frequency();
  const auto a = hand.torque(0, first.mesh_error, tau * f1), b = hand.torque(1, second.mesh_error, tau * f2);
  const double mean = first.wheel_torque();
  double largest = 0, smallest = 1e99;
  constexpr int places = 37 * 200;
  for (int i = 0; i < places; ++i) {
    const double t = i / (f1 * 200);
    const double torque = mean + (a * std::polar(1.0, tau * f1 * t) + b * std::polar(1.0, tau * f2 * t)).real();
    largest = std::max(largest, torque);
    smallest = std::min(smallest, torque);
  }
  const auto response = simulate(train, quick());
  BOOST_TEST(response.steady);
  BOOST_TEST_REQUIRE(response.shafts.size() == 2u);
  BOOST_TEST_REQUIRE(response.meshes.size() == 2u);
  const auto& shaft = response.shafts[0];
  record.close("mean torque", "N m", shaft.mean_torque, mean, 1e-6, "accuracy of the periodic motion");
  record.close("largest torque", "N m", shaft.largest_torque.value, largest, 1e-4, "places of the search");
  record.near("smallest torque, difference over the mean", "", (shaft.smallest_torque - smallest) / mean, 0, 2e-3,
              "smallest sample of 64");
  record.close("mean torque of the motor", "N m", response.shafts[1].mean_torque, first.pinion_torque, 1e-6,
               "accuracy of the periodic motion");
  record.close("mean force of the second mesh", "N", response.meshes[1].mean_force, second.static_force(), 1e-6,
               "accuracy of the periodic motion");
  BOOST_TEST(response.meshes[0].name == "first.mesh");
  BOOST_TEST(std::abs(a) > 0.02 * mean);
  BOOST_TEST(std::abs(b) > 0.02 * mean);
}

// A shaft of 1e5 N m/rad between parts of thousands of kg m^2 passes on the torque alone: both move as by themselves.
BOOST_AUTO_TEST_CASE(parts_on_a_soft_shaft_move_by_themselves) {
  annulus::test::Verification record("Parts of a train on a soft shaft",
                                     "the responses of the pairs by themselves under their torques");
  auto [first, second] = two_pairs();
  first.mesh = HarmonicStiffness{mean_stiffness(first.mesh), 0.05, 0};
  Train train{{part_of("first", first), part_of("second", second)},
              {{"between", {"first", "wheel"}, {"second", "pinion"}, 1e3, 0, 0}}};
  const auto response = simulate(train, quick());
  BOOST_TEST_REQUIRE(response.meshes.size() == 2u);
  for (const int i : {0, 1}) {
    const auto alone = evaluate_pair(i == 0 ? first : second, quick());
    const auto& mesh = response.meshes[static_cast<std::size_t>(i)];
    record.close("dynamic factor", "", mesh.dynamic_factor.value, alone.dynamic_factor.value, 1e-3,
                 "stiffness of the shaft, samples of the slower mesh");
    record.close("largest mesh force", "N", mesh.largest_force.value, alone.force_max.value, 1e-3,
                 "stiffness of the shaft, samples of the slower mesh");
  }
}

// The planetary stage delivers at its carrier or sun what the pair takes. Momentum: mean torques along the train.
BOOST_AUTO_TEST_CASE(a_planetary_stage_and_a_pair) {
  annulus::test::Verification record("A planetary stage, a pair and a generator in line",
                                     "matrices of both parts, put together by hand; statics");
  auto stage = stages::ring_paper();
  for (auto& errors : stage.planet_errors) errors = {};
  stage.ring.torsional_support = rigid;
  auto pair = two_pairs().first;
  pair.pinion.teeth = 54;
  pair.wheel.teeth = 37;
  pair.pinion.radius = pair.wheel.radius * 54 / 37;
  pair.mesh_error = {};
  pair.mesh = HarmonicStiffness{mean_stiffness(pair.mesh), 0.05, 0};
  pair.half_backlash = 100e-6;
  pair.pinion_speed = stage.carrier_speed;
  pair.pinion_torque = stage.carrier_torque();
  const Train train{{{"epicyclic", lumped_case(stage), stage.shaft_ends()}, part_of("parallel", pair)},
                    {{"carrier_shaft", {"epicyclic", "carrier"}, {"parallel", "pinion"}, 5e7, 0.05, 0}},
                    {{"generator", "parallel.wheel", 30, 5e6, 0.05}}};
  // By hand, lengths as in the parts.
  const auto epicyclic = assemble(stage), parallel = assemble(pair);
  const int n = epicyclic.dofs(), m = parallel.dofs();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n + m + 1, n + m + 1), stiffness = mass;
  mass.topLeftCorner(n, n) = epicyclic.mass();
  mass.block(n, n, m, m) = parallel.mass();
  mass(n + m, n + m) = 30 / std::pow(pair.wheel.radius, 2);
  stiffness.topLeftCorner(n, n) = stiffness_with_meshes(epicyclic, mean_tangents(epicyclic));
  stiffness.block(n, n, m, m) = stiffness_with_meshes(parallel, mean_tangents(parallel));
  Eigen::VectorXd twist = Eigen::VectorXd::Zero(n + m + 1);
  // The load holds the carrier back and drives the pinion: they turn in the same sense.
  twist[epicyclic.find("carrier_u")] = 1 / stage.carrier.radius;
  twist[n + parallel.find("pinion_u")] = -1 / pair.pinion.radius;
  stiffness += 5e7 * twist * twist.transpose();
  twist.setZero();
  twist[n + parallel.find("wheel_u")] = 1 / pair.wheel.radius;
  twist[n + m] = -1 / pair.wheel.radius;
  stiffness += 5e6 * twist * twist.transpose();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  const auto found = modes(train).modes;
  BOOST_TEST_REQUIRE(static_cast<int>(found.size()) == n + m + 1);
  for (Eigen::Index i = 1; i < n + m + 1; ++i)
    record.close("natural frequency", "Hz", found[static_cast<std::size_t>(i)].frequency,
                 std::sqrt(solver.eigenvalues()[i]) / tau, 1e-8, "rounding of both eigenvalue solvers");

  // 162 cycles of the ring mesh are a turn of the carrier, in which the pair has 54.
  BOOST_TEST(steady_problem(train).period_in_cycles == 3);
  const auto response = simulate(train, quick());
  BOOST_TEST(response.steady);
  BOOST_TEST_REQUIRE(response.shafts.size() == 2u);
  record.close("mean torque of the carrier's shaft", "N m", response.shafts[0].mean_torque, stage.carrier_torque(),
               1e-5, "accuracy of the periodic motion");
  record.close("mean torque of the generator's shaft", "N m", response.shafts[1].mean_torque, pair.wheel_torque(), 1e-5,
               "accuracy of the periodic motion");
  record.at_most("energy", "", response.energy.relative, 1e-4, "tolerance of the time integration");
}

// A 2K-V reducer behind a pair: mesh vectors that turn, integrated in time.
BOOST_AUTO_TEST_CASE(a_pair_in_front_of_a_reducer) {
  annulus::test::Verification record("A pair in front of a 2K-V reducer", "statics: torques along the train");
  auto reducer = stages::reducer();
  reducer.output_support = 0;
  reducer.sun_mesh = HarmonicStiffness{1.4e8, 0.1, 0};
  reducer.mesh_damping_ratio = reducer.support_damping_ratio = 0.08;
  auto pair = pairs::held(pairs::error_paper());
  for (auto* gear : {&pair.pinion, &pair.wheel}) {
    gear->inertia = 2e-5;
    gear->mass = 0.2;
    gear->radius /= 12;
  }
  pair.base_helix_angle = 0;
  pair.mesh = ConstantStiffness{1e8};
  pair.mesh_error = {1e-6, 0};
  const double ratio = pair.wheel.radius / pair.pinion.radius;
  pair.pinion_speed = reducer.output_speed * reducer.ratio() * ratio;
  pair.pinion_torque = reducer.output_torque / reducer.ratio() / ratio;
  const Train train{{part_of("first", pair), {"second", lumped_case(reducer), reducer.shaft_ends()}},
                    {{"between", {"first", "wheel"}, {"second", "input"}, 500, 0.08, 0}}};
  auto options = quick();
  options.max_window_cycles = 400;
  options.max_windows = 10;
  const auto response = simulate(train, options);
  BOOST_TEST_REQUIRE(response.shafts.size() == 1u);
  record.close("mean torque of the shaft", "N m", response.shafts[0].mean_torque,
               reducer.output_torque / reducer.ratio(), 2e-2, "a window that does not repeat");
  // Two sun meshes and two arc meshes behind that of the pair; no bearings.
  BOOST_TEST(response.meshes.size() == 5u);
  BOOST_TEST(response.meshes.back().name == "second.arc_pins2");
}

BOOST_AUTO_TEST_CASE(trains_that_are_refused) {
  const auto [first, second] = two_pairs();
  const auto good = train_of(first, second);
  const auto refused = [](const Train& train, const std::string& word) {
    BOOST_CHECK_EXCEPTION((void)assemble(train), InputError, [&](const InputError& error) {
      BOOST_TEST_CONTEXT(error.what()) BOOST_TEST(std::string(error.what()).find(word) != std::string::npos);
      return true;
    });
  };
  auto train = good;
  train.parts[1].name = "first";
  refused(train, "other parts");
  train = good;
  train.shafts.clear();
  train.rotors.clear();
  refused(train, "no shaft connects part 'second'");
  train = good;
  train.shafts[0].to.body = "rim";
  refused(train, "no body 'rim'");
  train = good;
  train.shafts[0].to = {"first", "pinion"};
  refused(train, "both ends");
  train = good;
  train.shafts[0].to.body = "wheel";
  refused(train, "N m");
  train = good;
  train.shafts.push_back(train.shafts[0]);
  train.shafts[1].name = "again";
  refused(train, "already");
  // Back to back: nothing but a torque that is locked in loads them.
  auto back = first;
  std::swap(back.pinion, back.wheel);
  back.pinion_speed = first.wheel_speed();
  back.pinion_torque = first.wheel_torque();
  train = {{part_of("first", first), part_of("back", back)},
           {{"between", {"first", "wheel"}, {"back", "pinion"}, shaft_stiffness},
            {"home", {"back", "wheel"}, {"first", "pinion"}, shaft_stiffness}}};
  refused(train, "shaft 'home': other shafts connect 'back' with 'first' already");
  train = good;
  train.rotors[0].on = "first.wheel";
  refused(train, "shaft 'between' leads to it");
  train = good;
  train.rotors[0].name = "between";
  refused(train, "have the name 'between'");
  train = good;
  train.shafts[0].stiffness = 0;
  refused(train, "stiffness");
}

BOOST_AUTO_TEST_SUITE_END()
