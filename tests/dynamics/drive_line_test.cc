#include "dynamics/system/drive_line.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/system/periods.h"
#include "dynamics/systems/helical_pair/pair_response.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/systems/two_k_v/two_k_v_response.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

/// Rotors beside a gear set: motors, generators, flywheels on their shafts.
BOOST_AUTO_TEST_SUITE(drive_line)

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Motor, pinion, wheel, machine and flywheel in line, with a constant mesh stiffness.
HelicalPair driven_pair() {
  auto pair = pairs::held(pairs::error_paper());
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  pair.rotors = {
      {"motor", "pinion", 20, 2e6, 0.02}, {"flywheel", "machine", 40, 3e6, 0.01}, {"machine", "wheel", 80, 5e6, 0.03}};
  return pair;
}

/// The same in angles: motor, pinion, wheel, machine, flywheel; both senses of rotation positive where the flanks
/// approach.
struct ByHand {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(5, 5), stiffness = mass, damping = mass;
  Eigen::VectorXd mesh = Eigen::VectorXd::Zero(5);
  double mesh_stiffness = 0, mesh_damping = 0;
  struct Shaft {
    int from, to;
    double stiffness, damping;
  };
  std::vector<Shaft> shafts;

  explicit ByHand(const HelicalPair& pair) {
    mass.diagonal() << 20, pair.pinion.inertia, pair.wheel.inertia, 80, 40;
    add_shaft(0, 1, 2e6, 0.02);
    add_shaft(3, 2, 5e6, 0.03);
    add_shaft(4, 3, 3e6, 0.01);
    const double c = std::cos(pair.base_helix_angle);
    mesh[1] = c * pair.pinion.radius;
    mesh[2] = c * pair.wheel.radius;
    mesh_stiffness = mean_stiffness(pair.mesh);
    const double inverse =
        std::pow(pair.pinion.radius, 2) / pair.pinion.inertia + std::pow(pair.wheel.radius, 2) / pair.wheel.inertia;
    mesh_damping = 2 * pair.mesh_damping_ratio * std::sqrt(mesh_stiffness / inverse);
    stiffness += mesh_stiffness * mesh * mesh.transpose();
    damping += mesh_damping * mesh * mesh.transpose();
  }

  void add_shaft(int from, int to, double k, double ratio) {
    const double c = 2 * ratio * std::sqrt(k / (1 / mass(from, from) + 1 / mass(to, to)));
    Eigen::VectorXd twist = Eigen::VectorXd::Zero(5);
    twist[from] = 1;
    twist[to] = -1;
    stiffness += k * twist * twist.transpose();
    damping += c * twist * twist.transpose();
    shafts.push_back({from, to, k, c});
  }

  [[nodiscard]] Eigen::VectorXd frequencies() const {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().cwiseMax(0).cwiseSqrt() / tau;
  }
  /// Angles under torques that change as exp(i rate t), rad/s: complex amplitudes.
  [[nodiscard]] Eigen::VectorXcd angles(const Eigen::VectorXcd& load, double rate) const {
    const std::complex<double> i(0, 1);
    Eigen::MatrixXcd dynamic = (stiffness - rate * rate * mass).cast<std::complex<double>>();
    dynamic += i * rate * damping.cast<std::complex<double>>();
    return dynamic.partialPivLu().solve(load);  // free rotation is no obstacle: rate is not 0
  }
  /// Torque of a shaft under them.
  [[nodiscard]] std::complex<double> torque(const Shaft& shaft, const Eigen::VectorXcd& load, double rate) const {
    const std::complex<double> i(0, 1);
    const Eigen::VectorXcd angle = angles(load, rate);
    return (shaft.stiffness + i * rate * shaft.damping) * (angle[shaft.from] - angle[shaft.to]);
  }
  /// Approach of the flanks under them.
  [[nodiscard]] std::complex<double> approach(const Eigen::VectorXcd& load, double rate) const {
    return mesh.cast<std::complex<double>>().dot(angles(load, rate));
  }
  /// Its amplitude under an error of the mesh.
  [[nodiscard]] double torque_amplitude(const Shaft& shaft, double error, double rate) const {
    const std::complex<double> i(0, 1);
    return std::abs(
        torque(shaft, (mesh_stiffness + i * rate * mesh_damping) * error * mesh.cast<std::complex<double>>(), rate));
  }
};

SimulationOptions quick() {
  SimulationOptions options;
  options.other_motions.starts = 0;
  return options;
}

/// Frequencies above zero.
std::vector<double> elastic(const Modes& modes) {
  std::vector<double> list;
  for (const auto& mode : modes.modes)
    if (mode.frequency > 0) list.push_back(mode.frequency);
  return list;
}

}  // namespace

BOOST_AUTO_TEST_CASE(natural_frequencies_of_a_train) {
  annulus::test::Verification record("Natural frequencies of a pair with motor, machine and flywheel",
                                     "matrices of the five inertias in angles, assembled by hand");
  const auto pair = driven_pair();
  const auto found = elastic(modes(pair));
  const Eigen::VectorXd expected = ByHand(pair).frequencies();
  BOOST_TEST_REQUIRE(found.size() == 4u);
  for (std::size_t i = 0; i < found.size(); ++i)
    record.close("natural frequency", "Hz", found[i], expected[static_cast<Eigen::Index>(i) + 1], 1e-9, "rounding");
}

// A stage of a sun, five planets and a carrier with a generator and a rotor: the matrices of the stage by itself with
// two rows and columns more.
BOOST_AUTO_TEST_CASE(natural_frequencies_of_a_stage_with_rotors) {
  annulus::test::Verification record("Natural frequencies of a planetary stage with rotor and generator",
                                     "matrices of the stage alone, extended by hand");
  const auto plain = stages::ring_paper();
  auto stage = plain;
  stage.rotors = {{"generator", "sun", 3, 4e6, 0.02}, {"blades", "carrier", 2000, 9e7, 0.02}};
  const auto system = assemble(plain);
  const int n = system.dofs();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n + 2, n + 2), stiffness = mass;
  mass.topLeftCorner(n, n) = system.mass();
  stiffness.topLeftCorner(n, n) = stiffness_with_meshes(system, mean_tangents(system));
  const auto add = [&](int at, const char* body, double radius, double inertia, double shaft) {
    mass(at, at) = inertia / (radius * radius);
    Eigen::VectorXd twist = Eigen::VectorXd::Zero(n + 2);
    twist[at] = 1 / radius;
    twist[system.find(body)] = -1 / radius;
    stiffness += shaft * twist * twist.transpose();
  };
  add(n, "sun_u", plain.sun.radius, 3, 4e6);
  add(n + 1, "carrier_u", plain.carrier.radius, 2000, 9e7);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  const auto found = modes(stage);
  for (Eigen::Index i = 1; i < n + 2; ++i)
    record.close("natural frequency", "Hz", found.modes[static_cast<std::size_t>(i)].frequency,
                 std::sqrt(solver.eigenvalues()[i]) / tau, 1e-8, "rounding of both eigenvalue solvers");
  // A mode of the train turns sun and carrier, and all planets alike.
  BOOST_TEST((found.kinds[1] == ModeKind::rotational));
  BOOST_TEST(found.modes[1].frequency < 0.7 * modes(plain).modes[1].frequency);
}

// Constant stiffness and an error at mesh frequency: one harmonic, whose amplitude in every shaft follows from five
// equations. Between samples, 64 to a cycle, peaks are found by parabolas: (pi/64)^4/24 of the amplitude.
BOOST_AUTO_TEST_CASE(torques_of_the_shafts) {
  annulus::test::Verification record("Torques of the shafts of a pair in line with motor, machine and flywheel",
                                     "complex amplitudes of the five inertias in angles, solved by hand");
  auto pair = driven_pair();
  const ByHand train(pair);
  const auto frequencies = elastic(modes(pair));
  // Below, at and above the first natural frequencies, where shafts and not teeth vibrate.
  for (const double frequency : {0.6 * frequencies[0], frequencies[1], 1.3 * frequencies[2], frequencies[3]}) {
    pair.pinion_speed = tau * frequency / pair.pinion.teeth;
    const auto response = evaluate_pair(pair, quick());
    BOOST_TEST_REQUIRE(response.shafts.size() == 3u);
    const double ratio = pair.wheel.radius / pair.pinion.radius;
    for (std::size_t i = 0; i < 3; ++i) {
      // In the order of the rotors: motor, flywheel, machine.
      const auto& shaft = train.shafts[i == 0 ? 0 : 3 - i];
      const double torque = pair.pinion_torque * (i == 0 ? 1 : ratio);
      const double amplitude = train.torque_amplitude(shaft, pair.mesh_error.amount, tau * frequency);
      const auto& result = response.shafts[i];
      record.close("nominal torque", "N m", result.nominal_torque, torque, 1e-12, "rounding");
      record.close("mean torque", "N m", result.mean_torque, torque, 1e-6, "accuracy of the periodic motion");
      record.close("largest torque", "N m", result.largest_torque.value, torque + amplitude, 1e-5,
                   "accuracy of the periodic motion, peaks between samples");
      record.near("smallest torque, difference over the nominal one", "",
                  (result.smallest_torque - torque + amplitude) / torque, 0, 2e-3, "smallest sample of 64");
      BOOST_TEST(result.largest_torque.error < 1e-2 * result.largest_torque.value);
    }
  }
}

// Two orders on the motor and one on the flywheel, of different periods: 21 cycles of the mesh are a turn of the
// pinion, 37 one of the wheel. In the frame of angles all senses are those of the loads.
BOOST_AUTO_TEST_CASE(torques_that_change_with_the_rotation) {
  annulus::test::Verification record("Torques of a motor and a machine that change with their rotation",
                                     "complex amplitudes of the five inertias in angles, solved by hand, superposed");
  auto pair = driven_pair();
  pair.mesh_error = {};
  const ByHand train(pair);
  pair.pinion_speed = tau * 11;
  BOOST_TEST(pair.error_period() == 1);
  pair.rotors[0].ripples = {{3, 900, 0.4}, {6, 1500, -1}};
  BOOST_TEST(pair.error_period() == 7);     // a third of a turn
  pair.rotors[1].ripples = {{37, 700, 0}};  // once per cycle
  BOOST_TEST(pair.error_period() == 7);
  const auto response = evaluate_pair(pair, quick());
  BOOST_TEST(response.steady);
  const double turn = pair.pinion_speed, wheel_turn = std::abs(pair.wheel_speed());
  const double ratio = pair.wheel.radius / pair.pinion.radius;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& shaft = train.shafts[i == 0 ? 0 : 3 - i];
    const auto by = [&](int body, const Rotor::Ripple& ripple, double rate) {
      const Eigen::VectorXcd load = std::polar(ripple.amplitude, ripple.phase) * Eigen::VectorXcd::Unit(5, body);
      return std::pair{rate, train.torque(shaft, load, rate)};
    };
    const std::array waves{by(0, pair.rotors[0].ripples[0], 3 * turn), by(0, pair.rotors[0].ripples[1], 6 * turn),
                           by(4, pair.rotors[1].ripples[0], 37 * wheel_turn)};
    const double mean = pair.pinion_torque * (i == 0 ? 1 : ratio);
    double largest = 0;
    constexpr int places = 7 * 400;
    for (int k = 0; k < places; ++k) {
      const double t = 7 * k / (places * pair.mesh_frequency());
      double torque = mean;
      for (const auto& [rate, amplitude] : waves) torque += (amplitude * std::polar(1.0, rate * t)).real();
      largest = std::max(largest, torque);
    }
    BOOST_TEST(largest > 1.01 * mean);
    record.close("mean torque", "N m", response.shafts[i].mean_torque, mean, 1e-6, "accuracy of the periodic motion");
    record.close("largest torque", "N m", response.shafts[i].largest_torque.value, largest, 1e-4,
                 "accuracy of the periodic motion, peaks between samples");
  }
}

// No torque and no errors: the motor alone excites the pair, whose flanks pull as well.
BOOST_AUTO_TEST_CASE(a_pair_driven_by_changing_torques_alone) {
  annulus::test::Verification record("A pair that a changing torque alone excites",
                                     "complex amplitudes of the five inertias in angles, solved by hand");
  auto pair = driven_pair();
  pair.mesh_error = {};
  pair.pinion_torque = 0;
  BOOST_CHECK_THROW((void)evaluate_pair(pair, quick()), InputError);
  pair.rotors[0].ripples = {{3, 900, 0.4}};
  const ByHand train(pair);
  const auto response = evaluate_pair(pair, quick());
  BOOST_TEST(response.steady);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::VectorXcd load = 900 * Eigen::VectorXcd::Unit(5, 0);
    const auto amplitude = std::abs(train.torque(train.shafts[i == 0 ? 0 : 3 - i], load, 3 * pair.pinion_speed));
    record.close("largest torque", "N m", response.shafts[i].largest_torque.value, amplitude, 1e-4,
                 "accuracy of the periodic motion, peaks between samples");
  }
  // Neither share of the transmission error has it.
  const auto shares = transmission_error_shares(pair, quick());
  BOOST_TEST(shares.all.dynamic > 0);
  BOOST_TEST(shares.errors_alone.dynamic == 0);
  BOOST_TEST(shares.stiffness_alone.dynamic == 0);
}

// The bound of the vibration is that of the motor's torque at the natural frequency where the mesh feels it most. The
// smallest deflection is that under the torque less what of its swing the motor and the pinion do not take as inertias.
BOOST_AUTO_TEST_CASE(a_changing_torque_brings_backlash_within_reach) {
  annulus::test::Verification record("Reach of the backlash under a torque that changes",
                                     "complex amplitudes at the natural frequencies of five inertias, solved by hand");
  auto pair = driven_pair();
  pair.mesh_error = {};
  pair.half_backlash = 100e-6;
  const auto reach = [&] {
    const auto [system, problem, turning] = lumped_case(pair);
    return reach_of_backlash(system, problem);
  };
  BOOST_TEST(reach() < 1e-9);
  pair.rotors[0].ripples = {{7, 900, 0}};  // smallest at one of 48 positions
  const ByHand train(pair);
  const double rate = 7 * pair.pinion_speed;
  Eigen::VectorXd turning(5);
  const double ratio = pair.pinion.radius / pair.wheel.radius;
  turning << 1, 1, -ratio, -ratio, -ratio;
  const double inertia = turning.dot(train.mass * turning), driving = train.mass(0, 0) + train.mass(1, 1);
  const double swing = 900 * (1 - driving / inertia) / train.mesh[1];
  double most = 0;
  for (const double frequency : train.frequencies()) {
    const double w = tau * frequency;
    if (w < rate / 3 || w > rate / 0.3) continue;
    most = std::max(most, std::abs(train.approach(900 * Eigen::VectorXcd::Unit(5, 0), w)));
  }
  BOOST_TEST(most > 0);
  record.close("bound over the static deflection", "", reach(),
               most * train.mesh_stiffness / (pair.static_force() - swing), 1e-6,
               "rounding; the same frequencies from two eigenvalue solvers");
}

// A coupling with play between a wheel and its machine, by the classical Runge-Kutta method in angles over 600 cycles.
// 2000 steps to a cycle: the sides of the play change in a step of 1/2000 of it.
BOOST_AUTO_TEST_CASE(a_coupling_with_backlash) {
  annulus::test::Verification record("A coupling with backlash in a drive-line",
                                     "Runge-Kutta integration of three inertias in angles");
  auto pair = pairs::held(pairs::error_paper());
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  pair.pinion_torque = 800;
  pair.mesh_error = {40e-6, 0};
  constexpr double inertia = 6, stiffness = 1.2e7, ratio = 0.1, half = 2e-5;
  pair.rotors = {{"machine", "wheel", inertia, stiffness, ratio, half}};
  const double frequency = 320;
  pair.pinion_speed = tau * frequency / pair.pinion.teeth;
  auto options = quick();
  options.samples_per_cycle = 512;  // the other side of the play is hit for a fiftieth of a cycle
  const auto response = evaluate_pair(pair, options);
  BOOST_TEST_REQUIRE(response.shafts.size() == 1u);
  const auto& shaft = response.shafts[0];

  const double r1 = pair.pinion.radius, r2 = pair.wheel.radius, j1 = pair.pinion.inertia, j2 = pair.wheel.inertia;
  const double cosine = std::cos(pair.base_helix_angle), k = mean_stiffness(pair.mesh);
  const double c = 2 * pair.mesh_damping_ratio * std::sqrt(k * pair.reduced_mass());
  const double shaft_c = 2 * ratio * std::sqrt(stiffness / (1 / inertia + 1 / j2));
  const double torque = pair.pinion_torque, load = torque * r2 / r1;
  // Positive: the machine is ahead of the wheel, in the sense of its load.
  const auto torque_of = [&](const Eigen::VectorXd& y) {
    const double twist = y[2] - y[1], rate = y[5] - y[4];
    if (std::abs(twist) <= half) return 0.0;
    return stiffness * (twist - std::copysign(half, twist)) + shaft_c * rate;
  };
  const auto slope = [&](double t, const Eigen::VectorXd& y) {
    const double e = pair.mesh_error.amount * std::sin(tau * frequency * t),
                 de = pair.mesh_error.amount * tau * frequency * std::cos(tau * frequency * t);
    const double force = k * (cosine * (r1 * y[0] + r2 * y[1]) - e) + c * (cosine * (r1 * y[3] + r2 * y[4]) - de);
    const double through = torque_of(y);
    Eigen::VectorXd dy(6);
    dy << y.tail(3), (torque - cosine * r1 * force) / j1, (through - cosine * r2 * force) / j2,
        (load - through) / inertia;
    return dy;
  };
  constexpr int steps = 2000, cycles = 600;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(6);
  y[2] = half + load / stiffness;
  y[1] = load / (cosine * cosine * k * r2 * r2);
  y[2] += y[1];
  const double h = 1 / (frequency * steps);
  double largest = 0, smallest = 0, open = 0;
  for (long i = 0; i < static_cast<long>(steps) * cycles; ++i) {
    const double t = static_cast<double>(i) * h;
    const Eigen::VectorXd a = slope(t, y), b = slope(t + h / 2, y + h / 2 * a), d = slope(t + h / 2, y + h / 2 * b),
                          g = slope(t + h, y + h * d);
    y += h / 6 * (a + 2 * b + 2 * d + g);
    if (i < static_cast<long>(steps) * (cycles - 20)) continue;
    const double now = torque_of(y);
    largest = std::max(largest, now);
    smallest = std::min(smallest, now);
    open += now == 0 ? 1.0 / (20 * steps) : 0;
  }
  BOOST_TEST(open > 0.05);
  BOOST_TEST(smallest < -0.1 * load);
  record.close("largest torque", "N m", shaft.largest_torque.value, largest, 2e-3, "tolerance of the periodic motion");
  record.near("smallest torque, difference over the mean", "", (shaft.smallest_torque - smallest) / load, 0, 1e-2,
              "first sample behind an impact");
  record.near("time without contact", "", shaft.contact_loss.value, open, 0.01, "samples of the periodic motion");
  record.close("mean torque", "N m", shaft.mean_torque, load, 2e-3, "tolerance of the periodic motion");
}

BOOST_AUTO_TEST_CASE(a_planetary_stage_with_rotors) {
  annulus::test::Verification record("A planetary stage between a rotor and a generator",
                                     "statics: torques of the members; conservation of momentum and energy");
  auto stage = stages::ring_paper();
  for (auto& errors : stage.planet_errors) errors = {};
  stage.rotors = {{"generator", "sun", 3, 4e6, 0.02}, {"blades", "carrier", 2000, 9e7, 0.02}};
  const auto response = simulate(stage, quick());
  BOOST_TEST(response.steady);
  BOOST_TEST_REQUIRE(response.shafts.size() == 2u);
  record.close("mean torque of the generator's shaft", "N m", response.shafts[0].mean_torque, stage.sun_torque, 1e-5,
               "accuracy of the periodic motion");
  record.close("mean torque of the blades' shaft", "N m", response.shafts[1].mean_torque, stage.carrier_torque(), 1e-5,
               "accuracy of the periodic motion");
  record.at_most("momentum of sun and generator", "", response.force_balance_relative, 1e-5,
                 "accuracy of the periodic motion");
  record.at_most("energy", "", response.energy.relative, 1e-5, "tolerance of the time integration");
  BOOST_TEST(response.shafts[0].torque_factor().value > 1);
}

// Gusts of 54 cycles per turn of the carrier, in which the ring mesh has 162: three mesh cycles. Constant stiffness.
BOOST_AUTO_TEST_CASE(a_planetary_stage_in_gusts) {
  annulus::test::Verification record("A planetary stage under a torque that changes with the carrier's rotation",
                                     "complex amplitudes of the matrices of its elements");
  auto stage = stages::ring_paper();
  for (auto& errors : stage.planet_errors) errors = {};
  stage.sun_mesh = ConstantStiffness{mean_stiffness(stage.sun_mesh)};
  stage.ring_mesh = ConstantStiffness{mean_stiffness(stage.ring_mesh)};
  constexpr double order = 54, share = 0.05, phase = 0.7;
  const double amplitude = share * stage.carrier_torque();
  stage.rotors = {{"generator", "sun", 3, 4e6, 0.02}, {"blades", "carrier", 20, 9e7, 0.02}};
  stage.rotors[1].ripples = {{order, amplitude, phase}};
  BOOST_TEST(stage.error_period() == 3);
  const auto system = assemble(stage);
  const double r = stage.carrier.radius, rate = order * std::abs(stage.carrier_speed);
  const std::complex<double> i(0, 1);
  Eigen::MatrixXcd dynamic =
      (stiffness_with_meshes(system, mean_tangents(system)) + system.rotating_stiffness() - rate * rate * system.mass())
          .cast<std::complex<double>>();
  dynamic += i * rate * (system.damping_with_meshes() + system.gyroscopic()).cast<std::complex<double>>();
  const int carrier = system.find("carrier_u"), blades = system.find("blades_u");
  const Eigen::VectorXcd motion = dynamic.partialPivLu().solve(
      Eigen::VectorXcd(std::polar(amplitude / r, phase) * Eigen::VectorXcd::Unit(system.dofs(), blades)));
  const double k = 9e7, c = 2 * 0.02 * std::sqrt(k / (1 / 20.0 + 1 / (r * r * system.mass()(carrier, carrier))));
  const double swing = std::abs((k + i * rate * c) * (motion[blades] - motion[carrier]) / r);
  const auto response = simulate(stage, quick());
  BOOST_TEST(response.steady);
  BOOST_TEST(swing > 0.01 * stage.carrier_torque());
  record.close("largest torque of the blades' shaft", "N m", response.shafts[1].largest_torque.value,
               stage.carrier_torque() + swing, 1e-4, "accuracy of the periodic motion, peaks between samples");
  record.close("mean torque of the blades' shaft", "N m", response.shafts[1].mean_torque, stage.carrier_torque(), 1e-5,
               "accuracy of the periodic motion");
  // The modes at rest are those of the stage, whatever its torques.
  auto at_rest = stage;
  at_rest.carrier_speed = 0;
  const auto still = elastic(modes(assemble(at_rest))), turning = elastic(modes(assemble(stage)));
  BOOST_TEST(still.size() == turning.size());
  BOOST_CHECK_EXCEPTION((void)simulate(at_rest, quick()), InputError, [](const InputError&) { return true; });
}

BOOST_AUTO_TEST_CASE(a_torque_of_a_rotor_that_does_not_turn) {
  auto stage = stages::ring_paper();
  stage.ring.torsional_support = 1e9;
  stage.rotors = {{"brake", "ring", 20, 9e7, 0.02}};
  stage.rotors[0].ripples = {{2, 100, 0}};
  BOOST_CHECK_EXCEPTION((void)simulate(stage, quick()), InputError, [](const InputError& error) {
    return std::string(error.what()).find("'ring' does not") != std::string::npos;
  });
}

// Torques of the motor whose orders have no common period: only a window of the motion is known, the statics of the
// reducer are not concerned.
BOOST_AUTO_TEST_CASE(a_reducer_whose_motor_has_no_common_period) {
  auto stage = stages::reducer();
  stage.output_support = 0;
  stage.mesh_damping_ratio = stage.support_damping_ratio = 0.05;
  auto options = quick();
  options.mesh_cycles = 3 * stage.planet_teeth;
  const auto alone = simulate(stage, options);
  stage.rotors = {{"motor", "input", 2e-5, 400, 0.05}};
  const double torque = 0.1 * stage.output_torque / stage.ratio();
  stage.rotors[0].ripples = {{std::numbers::sqrt2, torque, 0}, {std::numbers::pi, torque, 0}};
  BOOST_TEST(lumped_case(stage).problem.period_in_cycles == never_repeats);
  const auto response = simulate(stage, options);
  BOOST_TEST(!response.whole_period);
  BOOST_TEST(response.quasi_static.series.size() == alone.quasi_static.series.size());
  BOOST_TEST(response.quasi_static.peak_to_peak.value == alone.quasi_static.peak_to_peak.value);
}

BOOST_AUTO_TEST_CASE(a_reducer_with_motor_and_machine) {
  annulus::test::Verification record("A 2K-V reducer between motor and machine", "statics: torque and torque / ratio");
  auto stage = stages::reducer();
  stage.output_support = 0;
  stage.sun_mesh = HarmonicStiffness{1.4e8, 0.1, 0};
  stage.mesh_damping_ratio = stage.support_damping_ratio = 0.05;
  const auto alone = torsional_stiffness(stage, 3).mean();
  stage.rotors = {{"motor", "input", 2e-5, 400, 0.05}, {"machine", "output", 2, 5e4, 0.05}};
  BOOST_TEST(torsional_stiffness(stage, 3).mean() == alone);
  const auto response = simulate(stage, quick());
  BOOST_TEST_REQUIRE(response.shafts.size() == 2u);
  record.close("mean torque of the motor's shaft", "N m", response.shafts[0].mean_torque,
               stage.output_torque / stage.ratio(), 1e-4, "accuracy of the periodic motion");
  record.close("mean torque of the machine's shaft", "N m", response.shafts[1].mean_torque, stage.output_torque, 1e-4,
               "accuracy of the periodic motion");
  record.at_most("momentum of sun, input and motor", "", response.torque_balance_relative.value(), 1e-4,
                 "accuracy of the periodic motion");
}

BOOST_AUTO_TEST_CASE(rotors_that_are_refused) {
  const auto refused = [](std::vector<Rotor> rotors, const std::string& word) {
    auto stage = stages::ring_paper();
    stage.ring.torsional_support = rigid;
    stage.rotors = std::move(rotors);
    BOOST_CHECK_EXCEPTION((void)assemble(stage), InputError, [&](const InputError& error) {
      BOOST_TEST_CONTEXT(error.what()) BOOST_TEST(std::string(error.what()).find(word) != std::string::npos);
      return true;
    });
  };
  const Rotor good{"generator", "sun", 1, 1e6, 0.02};
  auto stage = stages::ring_paper();
  stage.rotors = {good};
  BOOST_TEST(assemble(stage).find("generator_u") == assemble(stage).dofs() - 1);
  refused({good, good}, "two rotors");
  refused({good, {"flywheel", "sun", 1, 1e6}}, "let this one lead to 'generator'");
  refused({{"planet2", "sun", 1, 1e6}}, "body");
  refused({{"", "sun", 1, 1e6}}, "empty");
  refused({{"generator", "ring", 1, 1e6}}, "held");
  refused({{"generator", "planet", 1, 1e6}}, "move around");
  refused({{"generator", "sum", 1, 1e6}}, "sun, carrier");
  refused({{"a", "b", 1, 1e6}, {"b", "a", 1, 1e6}}, "no body");
  BOOST_CHECK_EXCEPTION(
      (void)with_rotors(assemble(stage), {good}, stage.shaft_ends()), InputError,
      [](const InputError& error) { return std::string(error.what()).find("'generator_u'") != std::string::npos; });
  refused({{"generator", "sun", 0, 1e6}}, "inertia");
  refused({{"generator", "sun", 1, -1}}, "stiffness");
  refused({{"generator", "sun", 1, 1e6, 0, -1}}, "backlash");
}

BOOST_AUTO_TEST_SUITE_END()
