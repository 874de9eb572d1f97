#include "dynamics/transient/transient.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "core/units.h"
#include "dynamics/system/drive_line.h"
#include "dynamics/systems/helical_pair/pair_response.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/fixed_steps.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

/// Motions while speed and torque change.
BOOST_AUTO_TEST_SUITE(transient)

using namespace annulus::dynamics;
namespace units = annulus::units;
constexpr double pi = std::numbers::pi;

/// Rotations alone, with backlash and all excitations of a pair.
HelicalPair turning_pair() {
  auto pair = pairs::held(pairs::error_paper());
  pair.pinion.error = {20e-6, 0.3};
  pair.wheel.error = {15e-6, 1.1};
  pair.half_backlash = 30e-6;
  pair.mesh_damping_ratio = 0.03;
  return pair;
}

TransientOptions options_of(std::vector<Course::Point> points) {
  TransientOptions options;
  options.course.points = std::move(points);
  options.integrator.relative_tolerance = 1e-9;
  return options;
}

/// The same pair over the time, with absolute rotations: no pace, no forces of inertia beside those of the masses.
class PairInTime {
 public:
  PairInTime(const HelicalPair& pair, const Course& course)
      : pair_(pair), course_(course), c_(std::cos(pair.base_helix_angle)) {
    for (const auto* gear : {&pair.pinion, &pair.wheel}) mass_.push_back(gear->inertia / (gear->radius * gear->radius));
    rotation_ = pair.pinion.radius * pair.pinion_speed;
  }
  struct State {
    double angle = 0;       ///< of the pinion in its course, rad
    double u[2]{}, v[2]{};  ///< absolute, m and m/s
  };
  struct Contact {
    double deflection = 0, force = 0;  ///< m, N
  };
  [[nodiscard]] Contact contact(double t, const State& y) const {
    const auto [speed, acceleration, torque] = at(t);
    const double pinion = pair_.pinion.error.amount, wheel = pair_.wheel.error.amount,
                 rate = speed * pair_.pinion_speed;
    const double ratio = static_cast<double>(pair_.pinion.teeth) / pair_.wheel.teeth,
                 mesh = pair_.pinion.teeth * y.angle;
    double e = pair_.mesh_error.amount * std::sin(mesh + pair_.mesh_error.phase);
    double e_rate = pair_.mesh_error.amount * pair_.pinion.teeth * rate * std::cos(mesh + pair_.mesh_error.phase);
    e += pinion * std::sin(y.angle + pair_.pinion.error.phase) +
         wheel * std::sin(ratio * y.angle + pair_.wheel.error.phase);
    e_rate += pinion * rate * std::cos(y.angle + pair_.pinion.error.phase) +
              wheel * ratio * rate * std::cos(ratio * y.angle + pair_.wheel.error.phase);
    const double delta = c_ * (y.u[0] + y.u[1]) - e, half = pair_.half_backlash.value_or(0);
    if (std::abs(delta) <= half) return {delta, 0};
    const double damping = 2 * pair_.mesh_damping_ratio * std::sqrt(mean_stiffness(pair_.mesh) * pair_.reduced_mass());
    return {delta,
            stiffness(mesh) * (delta - std::copysign(half, delta)) + damping * (c_ * (y.v[0] + y.v[1]) - e_rate)};
  }
  /// Classical Runge-Kutta steps.
  void step(double t, double h, State& y) const {
    const auto rate = [&](double time, const State& s) {
      const auto [speed, acceleration, torque] = at(time);
      const double f = contact(time, s).force, load = torque * pair_.pinion_torque / pair_.pinion.radius;
      // The pinion drives and turns both inertias faster.
      const double faster = acceleration * rotation_ * (mass_[0] + mass_[1]);
      State d;
      d.angle = speed * pair_.pinion_speed;
      for (const int i : {0, 1}) {
        d.u[i] = s.v[i];
        d.v[i] = (load + (i == 0 ? faster : 0) - c_ * f) / mass_[static_cast<std::size_t>(i)];
      }
      return d;
    };
    const auto moved = [](const State& s, double by, const State& d) {
      State r = s;
      r.angle += by * d.angle;
      for (const int i : {0, 1}) r.u[i] += by * d.u[i], r.v[i] += by * d.v[i];
      return r;
    };
    const auto a = rate(t, y), b = rate(t + h / 2, moved(y, h / 2, a)), c = rate(t + h / 2, moved(y, h / 2, b)),
               d = rate(t + h, moved(y, h, c));
    for (const auto& [part, of] : {std::pair{&a, 1.0}, {&b, 2.0}, {&c, 2.0}, {&d, 1.0}})
      y = moved(y, h * of / 6, *part);
  }
  [[nodiscard]] double rotation() const { return rotation_; }

 private:
  /// At a phase of the mesh, rad.
  [[nodiscard]] double stiffness(double mesh) const {
    if (const auto* wave = std::get_if<HarmonicStiffness>(&pair_.mesh))
      return wave->mean * (1 + wave->ripple * std::cos(mesh - 2 * pi * wave->phase_shift));
    const auto& step = std::get<RectangularStiffness>(pair_.mesh);
    const double cycles = mesh / (2 * pi) - step.phase_shift;
    const double low = step.mean * (1 - step.ripple * step.duty);
    return cycles - std::floor(cycles) < step.duty ? low + step.mean * step.ripple : low;
  }
  struct Now {
    double speed, acceleration, torque;
  };
  [[nodiscard]] Now at(double t) const {
    std::size_t i = 0;
    while (i + 2 < course_.points.size() && t >= course_.points[i + 1].time) ++i;
    const auto &a = course_.points[i], &b = course_.points[i + 1];
    const double slope = (b.speed - a.speed) / (b.time - a.time), share = (t - a.time) / (b.time - a.time);
    return {a.speed + slope * (t - a.time), slope, a.torque + share * (b.torque - a.torque)};
  }

  const HelicalPair& pair_;
  const Course& course_;
  double c_, rotation_;
  std::vector<double> mass_;
};

/// Largest difference of the deflection along a course, over the largest deflection.
double difference_in_time(const HelicalPair& pair, const Course& course, double step) {
  const auto of = lumped_case(pair);
  const Pacing pacing(of.system, course, of.turning.dof, of.turning.velocity, AcceleratedBy::drive);
  SystemState state;
  state.q = Eigen::VectorXd::Constant(2, 40e-6);
  state.v = Eigen::VectorXd::Zero(2);
  const PairInTime exact(pair, course);
  PairInTime::State other;
  for (const int i : {0, 1}) {
    other.u[i] = 40e-6;
    other.v[i] = (i == 0 ? 1 : -1) * course.points.front().speed * exact.rotation();
  }
  IntegratorOptions options;
  options.relative_tolerance = 1e-10;
  auto workspace = of.system.workspace();
  std::vector<double> times, deflections;
  IntegrationObserver observer;
  observer.samples = 900;
  observer.sample = [&](int, const SystemState& s) {
    times.push_back(s.time);
    deflections.push_back(workspace.delta[0]);
  };
  (void)integrate(of.system, state, course.points.back().time, options, workspace, observer, &pacing);
  double t = 0, worst = 0, least = 0, most = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    annulus::test::step_to(t, times[i], step, exact, other);
    const auto expected = exact.contact(t, other);
    worst = std::max(worst, std::abs(deflections[i] - expected.deflection));
    most = std::max(most, expected.deflection);
    least = std::min(least, expected.force);
  }
  BOOST_TEST(least < -0.3 * pair.static_force());  // back flanks carried
  return worst / most;
}

// A run-up, an overload that ends in back flanks, and a run-down, against an integration over the time with absolute
// rotations, which knows neither nominal time nor pace. Also a start, a stop and rotation the other way round.
BOOST_AUTO_TEST_CASE(course_of_a_pair_against_absolute_rotations) {
  annulus::test::Verification record("Course of speed and torque", "absolute rotations over the time");
  const Course turning{{{0, 0.4, 0.8}, {0.12, 1.3, 1}, {0.2, 1.1, 1.6}, {0.26, 0.9, -0.7}, {0.35, 0.5, 0.9}}};
  const Course stopping{
      {{0, 0, 0.8}, {0.02, 0, 1}, {0.12, 1.1, 1.4}, {0.2, 0, 1}, {0.23, 0, -0.7}, {0.35, -0.6, 0.9}, {0.4, -0.2, 1}}};
  auto pair = turning_pair();
  const char* reason = "fixed steps at the contact events";
  for (const auto& [name, course] : {std::pair{"turning", &turning}, {"stopping and backwards", &stopping}})
    record.at_most(std::string("deflection, largest difference over the largest one, ") + name, "",
                   difference_in_time(pair, *course, 2e-7), 2e-4, reason);
  pair.mesh = RectangularStiffness{mean_stiffness(pair.mesh), 0.5, 0.6, 0.13};
  record.at_most("the same with a stiffness that jumps", "", difference_in_time(pair, stopping, 1e-7), 1e-3,
                 "fixed steps at the jumps");
}

// Over a run-up the work of the torques, those for the inertias among them, is what the masses gain and the dampers
// lose. Velocities are those over the time, rotations absolute.
BOOST_AUTO_TEST_CASE(energy_over_a_run_up) {
  annulus::test::Verification record("Energy over a run-up", "work of all torques");
  const auto pair = turning_pair();
  const auto of = lumped_case(pair);
  const Pacing pacing(of.system, {{{0, 0.5, 1}, {0.1, 1.5, 1.3}, {0.2, 1.2, 0.6}}}, of.turning.dof, of.turning.velocity,
                      AcceleratedBy::drive);
  const Eigen::VectorXd mass = of.system.mass().diagonal(), nominal = pacing.rotation();
  SystemState state;
  state.q = Eigen::VectorXd::Constant(2, 40e-6);
  state.v = Eigen::VectorXd::Zero(2);
  IntegratorOptions options;
  options.relative_tolerance = 1e-9;
  auto workspace = of.system.workspace();
  struct Sample {
    double time, kinetic, power, by_mesh;
  };
  std::vector<Sample> samples;
  IntegrationObserver observer;
  observer.samples = 480000;
  observer.sample = [&](int, const SystemState& s) {
    const auto now = pacing.at(s.time);
    const Eigen::VectorXd v = now.speed * nominal + s.v;
    Eigen::VectorXd torque = now.torque * of.system.load(LoadCause::torque);
    torque[0] += now.acceleration * nominal.dot(mass.asDiagonal() * nominal) / nominal[0];
    const double approach_rate = of.system.mesh_vector(0).dot(v);
    samples.push_back({s.time, v.dot(mass.asDiagonal() * v) / 2, torque.dot(v), workspace.force[0] * approach_rate});
  };
  (void)integrate(of.system, state, 0.2, options, workspace, observer, &pacing);
  double work = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto &a = samples[i - 1], &b = samples[i];
    work += (b.time - a.time) * (a.power - a.by_mesh + b.power - b.by_mesh) / 2;
  }
  const double gained = samples.back().kinetic - samples.front().kinetic;
  record.close("kinetic energy gained", "J", gained, work, 2e-5, "trapezoidal rule over samples; contact events");
  record.close("kinetic energy of the rotation", "J", gained,
               nominal.dot(mass.asDiagonal() * nominal) / 2 * (1.2 * 1.2 - 0.5 * 0.5), 1e-3, "vibration");
}

// At a constant pace the system is the one that was built at that speed: gyroscopic and centrifugal forces, dampers.
BOOST_AUTO_TEST_CASE(constant_pace_is_another_speed) {
  annulus::test::Verification record("Constant pace", "system built at that speed");
  auto stage = stages::ring_paper();
  stage.rotating_frame = true;
  stage.carrier_speed *= 3;  // so that the frame matters
  stage.sun.support = 4e7;
  for (const double pace : {0.5, 1.6, -0.8}) {
    auto other = stage;
    other.carrier_speed *= pace;
    const auto found = lumped_case(stage), expected = lumped_case(other);
    const Pacing pacing(found.system, {{{0, pace, 1}, {10, pace, 1}, {1e6, 2, 1}}}, found.turning.dof,
                        found.turning.velocity, AcceleratedBy::drive);
    BOOST_TEST((pacing.rotation() * pace - Pacing(expected.system, {{{0, 1, 1}, {1e6, 1.1, 1}}}, expected.turning.dof,
                                                  expected.turning.velocity, AcceleratedBy::load)
                                               .rotation())
                   .cwiseAbs()
                   .maxCoeff() < 1e-9 * pacing.rotation().cwiseAbs().maxCoeff());
    const auto forces = [&](const LumpedCase& of, const Pacing* with) {
      SystemState state;
      state.q = Eigen::VectorXd::LinSpaced(of.system.dofs(), 5e-6, 30e-6);
      state.v = Eigen::VectorXd::LinSpaced(of.system.dofs(), -1e-3, 2e-3);
      IntegratorOptions options;
      options.relative_tolerance = 1e-9;
      options.absolute_tolerance = 1e-15;
      options.method = Integrator::arkode_explicit;
      auto workspace = of.system.workspace();
      std::vector<double> list;
      IntegrationObserver observer;
      observer.samples = 200;
      observer.sample = [&](int, const SystemState&) {
        list.insert(list.end(), workspace.force.begin(), workspace.force.end());
      };
      const double duration = 20 / (std::abs(pace) * found.problem.mesh_frequency);
      (void)integrate(of.system, state, duration, options, workspace, observer, with);
      return list;
    };
    const auto a = forces(found, &pacing), b = forces(expected, nullptr);
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      worst = std::max(worst, std::abs(a[i] - b[i]));
      most = std::max(most, std::abs(b[i]));
    }
    record.at_most("mesh forces of twenty cycles, largest difference over the largest force", "", worst / most, 1e-5,
                   "tolerance of the integrators");
  }
}

// Lewis (1932): a constant acceleration through resonance leaves a vibration of amplitude e w sqrt(pi / (2 a)).
BOOST_AUTO_TEST_CASE(passage_through_resonance) {
  annulus::test::Verification record("Passage through resonance", "method of stationary phase");
  auto pair = turning_pair();
  pair.half_backlash.reset();
  pair.pinion.error = pair.wheel.error = {};
  pair.mesh_damping_ratio = 1e-7;
  const double stiffness = mean_stiffness(pair.mesh);
  pair.mesh = ConstantStiffness{stiffness};
  const double c = std::cos(pair.base_helix_angle);
  const double inverse =
      c * c *
      (std::pow(pair.pinion.radius, 2) / pair.pinion.inertia + std::pow(pair.wheel.radius, 2) / pair.wheel.inertia);
  const double natural = std::sqrt(stiffness * inverse), mesh = 2 * pi * pair.mesh_frequency();
  const double first = 0.4 * natural / mesh, last = 2.2 * natural / mesh;
  for (const double duration : {0.6, 2.4}) {
    const auto found = follow_course(lumped_case(pair), options_of({{0, first, 1}, {duration, last, 1}}));
    const double angular = (last - first) * mesh / duration;
    const double expected = stiffness * pair.mesh_error.amount * natural * std::sqrt(pi / (2 * angular));
    const Eigen::Index cycles = found.time.size(), tail = cycles / 8;
    // The forced vibration beyond resonance comes on top.
    const double swing = (found.largest.row(0).tail(tail).maxCoeff() - found.smallest.row(0).tail(tail).minCoeff()) / 2;
    const double beside = stiffness * pair.mesh_error.amount / (1 - std::pow(1 / 2.1, 2)), high = swing - beside;
    record.close("amplitude of the free vibration behind the resonance", "N", high, expected, 0.06,
                 "forced vibration; the lowest order of the method");
    BOOST_TEST(found.settled.value_or(false));
    // The peak comes late, above the natural frequency, and below the steady one.
    const auto peak = found.peak();
    BOOST_TEST(peak.speed * mesh > natural);
    BOOST_TEST(peak.speed * mesh < 1.4 * natural);
    // Order 1 of the spectra is the forced vibration.
    BOOST_TEST(std::abs(found.order[TransientResponse::window_cycles] - 1) < 1e-12);
  }
}

// Implicit methods need the derivatives along the course, in a rotating frame with gyroscopic terms.
BOOST_AUTO_TEST_CASE(implicit_methods_follow_courses) {
  annulus::test::Verification record("Courses by implicit methods", "explicit method, finite differences");
  auto stage = stages::ring_paper();
  stage.rotating_frame = true;
  stage.carrier_speed *= 3;
  stage.sun.support = 4e7;
  const auto of = lumped_case(stage);
  const Course course{{{0, 0, 1}, {0.02, 1, 1}, {0.04, -0.5, 1.2}}};
  const Pacing pacing(of.system, course, of.turning.dof, of.turning.velocity, AcceleratedBy::drive);
  const auto forces = [&](Integrator method) {
    SystemState state;
    state.q = Eigen::VectorXd::LinSpaced(of.system.dofs(), 5e-6, 30e-6);
    state.v = Eigen::VectorXd::Zero(of.system.dofs());
    IntegratorOptions options;
    options.method = method;
    options.relative_tolerance = 1e-8;
    auto workspace = of.system.workspace();
    Eigen::MatrixXd list(std::ssize(workspace.force), 200);
    IntegrationObserver observer;
    observer.samples = 200;
    observer.sample = [&](int i, const SystemState&) {
      list.col(i) = Eigen::Map<const Eigen::VectorXd>(workspace.force.data(), list.rows());
    };
    (void)integrate(of.system, state, 0.04, options, workspace, observer, &pacing);
    return list;
  };
  const auto expected = forces(Integrator::arkode_explicit);
  for (const auto method : {Integrator::arkode_implicit, Integrator::cvode_bdf})
    record.at_most("mesh forces, largest difference over the largest force", "",
                   (forces(method) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), 1e-5,
                   "tolerance of the integrators over many steps");
  // Column by column by differences.
  const int n = of.system.dofs();
  auto workspace = of.system.workspace();
  const auto now = pacing.at(0.035);
  Pacing::set_rates(now, workspace);
  Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(2 * n, 5e-6, 30e-6);
  Eigen::MatrixXd jacobian(2 * n, 2 * n), differences(2 * n, 2 * n);
  of.system.jacobian(now.nominal, y.data(), jacobian, workspace);
  pacing.correct(now, jacobian);
  for (int i = 0; i < 2 * n; ++i) {
    Eigen::VectorXd rate[2];
    constexpr double step = 1e-7;
    for (const int side : {0, 1}) {
      Eigen::VectorXd moved = y;
      moved[i] += side == 0 ? -step : step;
      rate[side].resize(2 * n);
      of.system.rhs(now.nominal, moved.data(), rate[side].data(), workspace);
      pacing.correct(now, moved.data(), rate[side].data());
    }
    differences.col(i) = (rate[1] - rate[0]) / (2 * step);
  }
  double worst = 0;
  for (int i = 0; i < 2 * n; ++i)
    worst = std::max(worst, (jacobian.col(i) - differences.col(i)).norm() / jacobian.col(i).norm());
  record.at_most("derivatives of the accelerations, by column", "", worst, 1e-6, "rounding of differences");
}

// A gear set that stands still under a torque settles in its equilibrium; a start and a stop pass every speed between.
BOOST_AUTO_TEST_CASE(start_and_stop) {
  annulus::test::Verification record("Standstill under a torque", "statics");
  auto pair = turning_pair();
  pair.pinion.error = pair.wheel.error = {};
  const auto found = follow_course(lumped_case(pair), options_of({{0, 0, 0.5}, {0.3, 1, 1}, {0.6, 0, 1}, {1.2, 0, 1}}));
  BOOST_TEST(found.settled.value_or(false));
  const Eigen::Index last = found.time.size() - 1;
  BOOST_TEST(found.speed[last] == 0);
  record.close("mesh force at rest", "N", found.mean(0, last), pair.static_force(), 1e-6, "rounding of samples");
  record.near("swing of it", "N", found.largest(0, last) - found.smallest(0, last), 0, 1e-3 * pair.static_force(),
              "what the dampers leave");
  // Mesh cycles of the run-up and the run-down, and time cycles at the slowest speed.
  const double slowest = TransientOptions::slowest, cycle = 1 / pair.mesh_frequency();
  const double turning = (1 - slowest) * 0.6 * (1 + slowest) / 2, slow = (0.6 * slowest + 0.6) * slowest;
  BOOST_TEST(std::abs(static_cast<double>(last + 1) - (turning + slow) / cycle) <= 1);
  // Orders exist where the whole window turns: the square of the speed changes by twice the acceleration over the way.
  const double change = 2 / 0.3 * TransientResponse::window_cycles / 2 * cycle;
  int turn = 0;
  for (Eigen::Index w = 0; w < found.window_time.size(); ++w) {
    const double square = std::pow(found.window_speed[w], 2);
    if (std::abs(found.window_time[w] - 0.3) < 0.02) continue;  // both accelerations
    const bool turns = square - change > slowest * slowest;
    BOOST_TEST(std::isfinite(found.amplitude(1, w)) == turns);
    turn += turns ? 1 : 0;
  }
  BOOST_TEST(turn > 3);
}

BOOST_AUTO_TEST_CASE(refused_courses) {
  const auto of = lumped_case(turning_pair());
  const auto follow = [&](std::vector<Course::Point> points) {
    (void)follow_course(of, options_of(std::move(points)));
  };
  BOOST_CHECK_THROW(follow({{0, 1, 1}}), annulus::InputError);
  BOOST_CHECK_THROW(follow({{0.1, 1, 1}, {1, 1, 1}}), annulus::InputError);
  BOOST_CHECK_THROW(follow({{0, 1, 1}, {1, std::nan(""), 1}}), annulus::InputError);
  BOOST_CHECK_THROW(follow({{0, 1, 1}, {1e6, 1.5, 1}}), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
