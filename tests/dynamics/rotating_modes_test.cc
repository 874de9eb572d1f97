#include "dynamics/systems/planetary/campbell.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/planetary/campbell.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(rotating_modes)

using namespace annulus::dynamics;
constexpr double turn = 2 * std::numbers::pi;

/// Lin and Parker's stage with teeth, so that it can turn: 162 = 48 + 2 x 57 leaves the ratio of the radii open.
PlanetaryStage turning(int planets) {
  auto stage = stages::lin_parker(planets);
  stage.sun_teeth = 48;
  stage.planet_teeth = 57;
  stage.ring_teeth = 162;
  return stage;
}

/// Only the sun moves, in x and y, on its support: the planets are held by meshes of next to no stiffness.
PlanetaryStage single_mass(double support, double damping_ratio) {
  auto stage = turning(3);
  stage.sun = {2.0, 1.0, 1, support, rigid, {}};
  stage.ring.support = stage.carrier.support = rigid;
  stage.ring.torsional_support = stage.carrier.torsional_support = rigid;
  stage.planet_bearings.clear();
  stage.sun_mesh = stage.ring_mesh = ConstantStiffness{1e-3};
  stage.support_damping_ratio = damping_ratio;
  return stage;
}

BOOST_AUTO_TEST_CASE(at_rest_they_are_the_real_modes) {
  annulus::test::Verification record("Complex modes at rest", "the symmetric eigenproblem, another solver");
  const auto stage = turning(5);
  const auto real = annulus::dynamics::modes(stage);
  const auto found = annulus::dynamics::rotating_modes(stage, ModeDamping::undamped);
  BOOST_TEST((found.dofs == real.dofs));
  BOOST_REQUIRE(found.modes.size() == real.modes.size());
  const auto mass = assemble(stage).mass();
  for (std::size_t i = 0; i < real.modes.size(); ++i) {
    // The unsymmetric solver: eps x the highest frequency x the DOFs, against the lowest of about 700 Hz.
    record.near("frequency", "Hz", found.modes[i].frequency, real.modes[i].frequency,
                1e-11 * real.modes.back().frequency, "rounding of the unsymmetric solver");
    record.near("damping ratio", "", found.modes[i].damping_ratio, 0, 1e-10, "rounding of the unsymmetric solver");
    BOOST_TEST((found.modes[i].kind == real.kinds[i]), i << " " << to_string(found.modes[i].kind));
    BOOST_TEST(std::abs(found.modes[i].shape.dot(mass * found.modes[i].shape) - 1.0) <= 1e-12);
  }
}

// A mass on isotropic springs seen from a turning frame whirls at sqrt(k/m) -+ Omega.
BOOST_AUTO_TEST_CASE(single_mass_in_the_turning_frame) {
  annulus::test::Verification record("Whirling of a mass on isotropic springs seen from a turning frame",
                                     "closed form: sqrt(k/m) -+ speed; with a damper in the housing sqrt(1 - zeta^2) "
                                     "sqrt(k/m) -+ speed");
  for (const double speed : {0.0, 50.0, 400.0}) {
    auto stage = single_mass(2e6, 0.02);  // sqrt(k/m) = 1000 rad/s
    stage.carrier_speed = speed;
    const double omega = 1000, zeta = 0.02;
    auto found = annulus::dynamics::rotating_modes(stage, ModeDamping::undamped);
    const auto lowest_pair = [&] {
      std::vector<RotatingMode> pair;
      for (const auto& mode : found.modes)
        if (std::norm(mode.shape[0]) + std::norm(mode.shape[1]) > 0.1) pair.push_back(mode);
      BOOST_REQUIRE(pair.size() == 2U);
      return pair;
    };
    auto pair = lowest_pair();
    // The meshes' 1e-3 N/m shift the frequency by 1e-9 of itself; rounding is far below.
    const char* origin = "meshes of 1e-3 N/m shift 1e-9 of it";
    record.near("backward whirl", "rad/s", pair[0].frequency * turn, omega - speed, 1e-6, origin);
    record.near("forward whirl", "rad/s", pair[1].frequency * turn, omega + speed, 1e-6, origin);
    if (speed > 0)  // whirling: y is 90 degrees from x, at the same amplitude
      for (const auto& mode : pair)
        BOOST_TEST(std::abs(mode.shape[1] / mode.shape[0] * mode.shape[1] / mode.shape[0] + 1.0) <= 1e-6);

    // The damper stands in the housing: lambda = -zeta omega +- i omega sqrt(1 - zeta^2) turned by -+ i Omega.
    found = annulus::dynamics::rotating_modes(stage, ModeDamping::damped);
    pair = lowest_pair();
    const double damped = omega * std::sqrt(1 - zeta * zeta);
    record.near("backward whirl, damped", "rad/s", pair[0].frequency * turn, damped - speed, 1e-6, origin);
    record.near("forward whirl, damped", "rad/s", pair[1].frequency * turn, damped + speed, 1e-6, origin);
    for (const int i : {0, 1}) {
      const double size = std::hypot(zeta * omega, pair[i].frequency * turn);
      record.near("damping ratio", "", pair[i].damping_ratio, zeta * omega / size, 1e-9, origin);
    }
  }
}

// The symmetry of equal planets outlives the rotation: kinds and their numbers stay, pairs part.
BOOST_AUTO_TEST_CASE(structure_at_speed) {
  annulus::test::Verification record("Modes of three to seven planets at speed, with and without dampers",
                                     "symmetry: 6 rotational, 12 translational and 3 (N - 3) planet modes, as at rest");
  for (int planets = 3; planets <= 7; ++planets)
    for (const auto damping : {ModeDamping::undamped, ModeDamping::damped}) {
      auto stage = turning(planets);
      stage.carrier_speed = 500;
      stage.mesh_damping_ratio = 0.05;
      stage.support_damping_ratio = 0.02;
      std::map<ModeKind, int> count;
      const auto found = annulus::dynamics::rotating_modes(stage, damping);
      for (const auto& mode : found.modes) {
        ++count[mode.kind];
        if (damping == ModeDamping::damped && mode.frequency > 0) BOOST_TEST(mode.damping_ratio > 0.0);
      }
      record.near("lowest frequency", "Hz", found.modes.front().frequency, 0, 0, "turning as a whole stays free");
      record.at_least("second frequency", "Hz", found.modes[1].frequency, 1, "far above rounding");
      BOOST_TEST(found.modes[1].frequency > 1.0);
      record.near("rotational modes", "", count[ModeKind::rotational], 6, 0, "symmetry");
      record.near("translational modes", "", count[ModeKind::translational], 12, 0, "symmetry");
      record.near("planet modes of " + std::to_string(planets) + " planets", "", count[ModeKind::planet],
                  3 * (planets - 3), 0, "symmetry");
    }
}

// A residual: each mode solves the quadratic eigenproblem it is a mode of.
BOOST_AUTO_TEST_CASE(modes_solve_the_quadratic_eigenproblem) {
  annulus::test::Verification record("Modes of the turning, damped stage",
                                     "definition: residual of the quadratic eigenproblem");
  auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const auto stiffness = stiffness_with_meshes(system, mean_tangents(assemble(stage)));
  Eigen::MatrixXd rate = system.damping() + system.gyroscopic();
  for (int m = 0; m < 10; ++m)
    rate += system.meshes()[m].damping * system.mesh_vector(m) * system.mesh_vector(m).transpose();
  const auto found = annulus::dynamics::rotating_modes(stage, ModeDamping::damped);
  for (const auto& mode : found.modes) {
    if (mode.frequency == 0) continue;
    const double imaginary = turn * mode.frequency;
    const double real = -mode.damping_ratio * imaginary / std::sqrt(1 - mode.damping_ratio * mode.damping_ratio);
    const std::complex<double> lambda(real, imaginary);
    const Eigen::VectorXcd residual = lambda * lambda * system.mass() * mode.shape + lambda * rate * mode.shape +
                                      (stiffness + system.rotating_stiffness()) * mode.shape;
    // Backward error of the unsymmetric solver: eps x size x the largest stiffness.
    record.at_most("residual over the largest stiffness", "",
                   residual.cwiseAbs().maxCoeff() / stiffness.cwiseAbs().maxCoeff(), 1e-12,
                   "backward error of the solver: eps x size");
  }
}

BOOST_AUTO_TEST_CASE(campbell_of_a_single_mass) {
  annulus::test::Verification record(
      "Campbell diagram of a single mass",
      "closed form: curves 1000 rad/s -+ speed; order h meets them at 1000 / (162 h +- 1)");
  auto stage = single_mass(2e6, 0);
  std::vector<double> speeds;
  for (int i = 0; i <= 20; ++i) speeds.push_back(i);
  const auto diagram = campbell(stage, speeds, {.orders = 3});
  BOOST_REQUIRE(diagram.mesh_frequency.size() == 21U);
  BOOST_TEST(std::abs(diagram.mesh_frequency[20] - 162 * 20 / turn) <= 1e-12);
  int forward = 0, backward = 0;
  for (const auto& curve : diagram.curves) {
    if (std::abs(curve.frequency[0] * turn - 1000) > 1) continue;
    const double slope = (curve.frequency[20] - curve.frequency[0]) * turn / 20;
    (slope > 0 ? forward : backward) += 1;
    for (int i = 0; i <= 20; ++i) {
      record.near("frequency along a curve", "rad/s", curve.frequency[i] * turn, 1000 + std::round(slope) * speeds[i],
                  1e-6, "meshes of 1e-3 N/m shift 1e-9 of it");
      BOOST_TEST(curve.mac[i] > 0.99);
    }
  }
  BOOST_TEST(forward == 1);
  BOOST_TEST(backward == 1);
  // h 162 Omega = 1000 -+ Omega
  std::vector<double> expected;
  for (const double h : {1, 2, 3})
    for (const double sign : {-1, 1}) expected.push_back(1000 / (162 * h + sign));
  std::sort(expected.begin(), expected.end());
  std::vector<double> found;
  for (const auto& crossing : diagram.crossings)
    if (crossing.frequency * turn > 900) found.push_back(crossing.speed);
  BOOST_REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    record.near("critical speeds of the carrier", "rad/s", found[i], expected[i], 1e-8,
                "meshes of 1e-3 N/m shift 1e-9 of it");
}

BOOST_AUTO_TEST_CASE(campbell_follows_curves_through_crossings) {
  annulus::test::Verification record("Curves of a Campbell diagram through their crossings",
                                     "modes of the last speed; continuity; the line of each order");
  auto stage = turning(5);
  std::vector<double> speeds;
  for (int i = 0; i <= 60; ++i) speeds.push_back(i * 20.0);  // pairs part by some 380 Hz and cross others
  const auto diagram = campbell(stage, speeds);
  BOOST_REQUIRE(diagram.curves.size() == 24U);
  for (const auto& curve : diagram.curves) {
    for (std::size_t i = 1; i < speeds.size(); ++i) {
      record.at_least("modal assurance criterion of two speeds", "", curve.mac[i], 0.5, "no other curve is as like");
      BOOST_TEST(curve.mac[i] > 0.5);
    }
    // Continuous in slope: the second difference stays below what a jump to a neighbour would make of it.
    for (std::size_t i = 2; i < speeds.size(); ++i) {
      const double bend = std::abs(curve.frequency[i] - 2 * curve.frequency[i - 1] + curve.frequency[i - 2]);
      record.at_most("second difference along a curve", "Hz", bend, 3, "far below a jump to a neighbour");
      BOOST_TEST(bend < 3.0);
    }
  }
  // At each speed the curves are all modes of that speed, whatever their order.
  stage.carrier_speed = speeds.back();
  std::vector<double> last;
  for (const auto& curve : diagram.curves) last.push_back(curve.frequency.back());
  std::sort(last.begin(), last.end());
  const auto found = annulus::dynamics::rotating_modes(stage, ModeDamping::undamped);
  for (std::size_t i = 0; i < last.size(); ++i)
    record.near("frequency at the last speed", "Hz", last[i], found.modes[i].frequency, 0, "the same modes");
  // Each crossing lies on its curve and its line.
  for (const auto& crossing : diagram.crossings)
    record.near("frequency of a crossing on the line of its order", "Hz", crossing.frequency,
                crossing.order * 162 * crossing.speed / turn, 1e-9 * crossing.frequency, "rounding");
  BOOST_TEST(!diagram.crossings.empty());
}

// Parker and Lin 2004: order h excites rotational modes when h z_s is a multiple of N, translational ones when it is
// one more or less, planet modes otherwise.
BOOST_AUTO_TEST_CASE(phasing_decides_what_an_order_excites) {
  annulus::test::Verification record("Which mesh orders excite which modes",
                                     "Parker and Lin, J. Mech. Des. 126 (2004): rotational modes when h z_s is a "
                                     "multiple of N, translational ones when one more or less, else planet modes");
  const auto stage = stages::ring_paper();  // 48 teeth, 5 planets
  std::vector<double> speeds;
  for (int i = 0; i <= 60; ++i) speeds.push_back(i);
  const auto diagram = campbell(stage, speeds, {.orders = 10});
  std::map<ModeKind, int> seen;
  for (const auto& crossing : diagram.crossings) {
    const auto kind = diagram.curves[crossing.curve].kind;
    const int rest = crossing.order * 48 % 5;
    const bool allowed = kind == ModeKind::rotational      ? rest == 0
                         : kind == ModeKind::translational ? rest == 1 || rest == 4
                                                           : rest == 2 || rest == 3;
    if (!allowed)
      record.near("participation of orders that cannot excite", "", crossing.participation, 0, 1e-6,
                  "eps over the gap to the next mode");
    // Of a parted translational pair one whirls with the excitation and one against it.
    if (allowed && kind != ModeKind::translational)
      record.near("participation of orders that excite", "", crossing.participation, 1, 1e-6,
                  "eps over the gap to the next mode");
    if (allowed && crossing.participation > 0.99) ++seen[kind];
  }
  for (const auto kind : {ModeKind::rotational, ModeKind::translational, ModeKind::planet}) BOOST_TEST(seen[kind] > 0);
}

BOOST_AUTO_TEST_CASE(speeds_are_checked) {
  BOOST_CHECK_THROW((void)campbell(turning(3), {}), annulus::InputError);
  BOOST_CHECK_THROW((void)campbell(turning(3), {1, 1}), annulus::InputError);
  BOOST_CHECK_THROW((void)campbell(turning(3), {-1, 1}), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
