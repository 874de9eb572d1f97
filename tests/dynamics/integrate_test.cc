#include "dynamics/time_integration/integrate.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/errors.h"
#include "core/floating_point.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(integration)

using namespace annulus::dynamics;

constexpr Integrator adaptive[] = {Integrator::arkode_explicit, Integrator::cvode_adams, Integrator::cvode_bdf};

struct Oscillator {
  double mass = 2, stiffness = 5e4, damping = 0;  // 25.2 Hz
  [[nodiscard]] LumpedSystem system() const {
    LumpedSystemBuilder builder;
    const auto x = builder.add_dof("x");
    builder.add_mass(x, mass);
    builder.add_spring(x, stiffness, damping);
    return builder.build();
  }
};

SystemState start(double q, double v) {
  SystemState state;
  state.q = Eigen::VectorXd::Constant(1, q);
  state.v = Eigen::VectorXd::Constant(1, v);
  return state;
}

IntegratorOptions tight(Integrator method, double tolerance, double absolute) {
  IntegratorOptions options;
  options.method = method;
  options.relative_tolerance = tolerance;
  options.absolute_tolerance = absolute;
  return options;
}

BOOST_AUTO_TEST_CASE(damped_free_vibration_in_closed_form) {
  annulus::test::Verification record("Damped free vibration of one mass, three integrators",
                                     "closed form: x0 exp(-d t) (cos w t + d / w sin w t)");
  const Oscillator oscillator{2, 5e4, 40};
  const double w0 = std::sqrt(5e4 / 2), decay = 40.0 / 4, w = std::sqrt(w0 * w0 - decay * decay), t = 0.2;
  const double expected = 1e-3 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
  for (const auto method : adaptive)
    for (const double tolerance : {1e-6, 1e-9}) {
      const auto system = oscillator.system();
      auto workspace = system.workspace();
      auto state = start(1e-3, 0);
      const auto statistics = integrate(system, state, t, tight(method, tolerance, 1e-3 * tolerance), workspace);
      // Local errors of at most 2 x tolerance (relative + absolute) per step add up.
      record.near(
          tolerance < 1e-8 ? "displacement after 0.2 s, tolerance 1e-9" : "displacement after 0.2 s, tolerance 1e-6",
          "m", state.q[0], expected, 2 * tolerance * 1e-3 * static_cast<double>(statistics.steps),
          "steps x tolerance of the integrator x amplitude");
      BOOST_TEST(state.time == t);
      BOOST_TEST((statistics.jacobian_evaluations > 0) == (method == Integrator::cvode_bdf));
    }
}

BOOST_AUTO_TEST_CASE(runge_kutta_has_order_four) {
  annulus::test::Verification record("Fixed-step Runge-Kutta has order four", "closed form: x0 cos w t");
  const auto system = Oscillator{}.system();
  const double w = std::sqrt(2.5e4), t = 0.1;
  double previous = 0;
  std::vector<double> step_sizes, errors;
  for (const int steps : {100, 200, 400}) {
    auto workspace = system.workspace();
    auto state = start(1e-3, 0);
    IntegratorOptions options = tight(Integrator::runge_kutta_4, 1e-6, 1e-9);
    options.fixed_step = t / steps;
    const auto statistics = integrate(system, state, t, options, workspace);
    BOOST_TEST(std::abs(statistics.steps - steps) <= 1);  // rounding may leave a last sliver
    const double error = std::hypot(state.q[0] - 1e-3 * std::cos(w * t), state.v[0] / w + 1e-3 * std::sin(w * t));
    if (previous > 0)  // bounded from both sides: neither less nor by chance more
      record.near("order of convergence", "", std::log2(previous / error), 4, 0.2, "steps of finite size");
    previous = error;
    step_sizes.push_back(t / steps);
    errors.push_back(error / 1e-3);
  }
  record.at_most("error over amplitude, w h = 0.04", "", previous / 1e-3, 1e-6, "n (w h)^5 / 120 = 3e-7");
  record.convergence("Error of Runge-Kutta; dashed: order 4", "step, s", "error over amplitude", "", step_sizes, errors,
                     4);
}

// A mass between the two flanks of a dead band: free flight, half a sine in each contact.
BOOST_AUTO_TEST_CASE(backlash_oscillator_in_closed_form) {
  annulus::test::Verification record("A mass between the flanks of a dead band",
                                     "closed form: free flight between, half a sine in each contact");
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("x");
  mesh.excitation = ConstantStiffness{5e4};
  mesh.half_backlash = 1e-3;
  builder.add_mass(mesh.b, 2);
  builder.add_mesh(mesh);
  const auto system = builder.build();
  const double speed = 0.3, period = 2 * (2e-3 / speed) + 2 * std::numbers::pi / std::sqrt(2.5e4);
  for (const auto method : adaptive) {
    auto workspace = system.workspace();
    auto state = start(0, speed);
    const double tolerance = 1e-9;
    const auto statistics =
        integrate(system, state, 20 * period, tight(method, tolerance, 1e-3 * tolerance), workspace);
    BOOST_TEST(statistics.contact_events == 80);  // in and out, on both sides
    // Steps x tolerance of the excursion (1e-3 + 0.3/158 m), times 10: an error in speed goes on shifting the phase for
    // the rest of the flights.
    record.near("displacement after 20 periods", "m", state.q[0], 0,
                10 * tolerance * 3e-3 * static_cast<double>(statistics.steps),
                "10 x steps x tolerance of the integrator x excursion");
    record.near("speed after 20 periods", "m/s", state.v[0], speed,
                2 * tolerance * static_cast<double>(statistics.steps) * speed, "steps x tolerance of the integrator");
  }
}

// A body at rest between the flanks is struck by an error that changes much faster than the body moves: nothing but the
// gap makes steps short.
BOOST_AUTO_TEST_CASE(fast_errors_strike_a_body_at_rest) {
  annulus::test::Verification record("A fast error strikes a body at rest between the flanks",
                                     "closed form of the instant; fixed steps a thousand times shorter");
  constexpr double mass = 2, half = 1e-4, amount = 1.05e-4, rate = 4000;
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.b = builder.add_dof("x");
  mesh.excitation = ConstantStiffness{5e6};
  mesh.half_backlash = half;
  mesh.frequency = 10;
  mesh.errors = {{amount, rate, 0}};
  builder.add_mass(mesh.b, mass);
  builder.add_mesh(mesh);
  const auto system = builder.build();
  const double struck = std::asin(half / amount) / rate;
  const auto after = [&](IntegratorOptions options, double end) {
    auto workspace = system.workspace();
    auto state = start(0, 0);
    integrate(system, state, end, options, workspace);
    return state.v[0];
  };
  const auto adaptive_options = tight(Integrator::arkode_explicit, 1e-8, 1e-14);
  auto fixed = tight(Integrator::runge_kutta_4, 1e-8, 1e-14);
  fixed.fixed_step = 2 * std::numbers::pi / rate / 2e4;
  BOOST_TEST(after(adaptive_options, 0.999 * struck) == 0.0);
  BOOST_TEST(after(adaptive_options, 1.01 * struck) > 0);
  const double end = 0.4 * 2 * std::numbers::pi / rate;  // behind the crest
  const double expected = after(fixed, end);
  record.close("velocity after the first strike", "m/s", after(adaptive_options, end), expected, 1e-5,
               "tolerance of the integrator at the events");
}

// Beside a common velocity, the difference of two velocities is zero for longer than the shortest step.
BOOST_AUTO_TEST_CASE(turning_within_the_gap_beside_a_fast_common_motion) {
  annulus::test::Verification record("Two bodies fly together and turn within their gap", "closed form: a parabola");
  constexpr double common = 100, thrown = 0.04, acceleration = 1, half = 1e-3, end = 0.06;
  LumpedSystemBuilder builder;
  const auto first = builder.add_dof("first"), second = builder.add_dof("second");
  builder.add_mass(first, 2);
  builder.add_mass(second, 2);
  builder.add_load(second, -2 * acceleration);
  MeshElement mesh;
  mesh.b = second + -1.0 * first;
  mesh.excitation = ConstantStiffness{4e8};
  mesh.half_backlash = half;
  builder.add_mesh(mesh);
  const auto system = builder.build();
  for (const auto method : adaptive) {
    auto workspace = system.workspace();
    SystemState state;
    state.q = Eigen::Vector2d::Zero();
    state.v = Eigen::Vector2d{common, common + thrown};
    const auto statistics = integrate(system, state, end, tight(method, 1e-10, 1e-13), workspace);
    record.near("distance after the turn", "m", state.q[1] - state.q[0], thrown * end - acceleration * end * end / 2,
                2 * 1e-10 * static_cast<double>(statistics.steps) * common * end,
                "steps x tolerance of the integrator");
  }
}

// Meissner's equation: a stiffness switching between two values, each piece an exact rotation in the phase plane.
// Steps of free flight are far longer than a visit to the back flanks, which begins and ends within one.
BOOST_AUTO_TEST_CASE(brief_contact_after_a_flight_in_closed_form) {
  annulus::test::Verification record("Brief contact with the back flanks after a free flight",
                                     "closed form: parabolas and an arc of a sine");
  constexpr double mass = 2, stiffness = 4e8, load = 60, half = 1e-3;
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("x");
  builder.add_mass(x, mass);
  builder.add_load(x, load);
  MeshElement mesh;
  mesh.b = x;
  mesh.excitation = ConstantStiffness{stiffness};
  mesh.half_backlash = half;
  builder.add_mesh(mesh);
  const auto system = builder.build();
  const double a = load / mass, w = std::sqrt(stiffness / mass);
  for (const double at_back : {0.01, 0.1}) {  // m/s, on arrival
    const double thrown = std::sqrt(at_back * at_back + 4 * a * half);
    const double visit = 2 / w * std::atan(at_back * w / a), flights = 2 * (thrown - at_back) / a;
    BOOST_TEST(visit < 0.02 * flights);
    for (const auto method : adaptive) {
      auto state = start(half - 1e-12, -thrown);
      auto workspace = system.workspace();
      const auto statistics = integrate(system, state, visit + flights, tight(method, 1e-8, 1e-13), workspace);
      BOOST_TEST(statistics.contact_events >= 2);
      record.close("velocity on return", "m/s", state.v[0], thrown, 1e-5, "tolerance of the integrator at the events");
      record.near("place on return", "m", state.q[0], half, 1e-5 * 2 * half,
                  "tolerance of the integrator at the events");
    }
  }
}

BOOST_AUTO_TEST_CASE(rectangular_stiffness_in_closed_form) {
  annulus::test::Verification record("A stiffness switching between two values",
                                     "closed form of Meissner's equation: each piece a rotation in the phase plane");
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("x");
  mesh.excitation = RectangularStiffness{5e4, 0.6, 0.3, 0};
  mesh.frequency = 70;
  mesh.phase_offset = 0.1;
  builder.add_mass(mesh.b, 2);
  builder.add_mesh(mesh);
  const auto system = builder.build();
  const auto piece = [](double stiffness, double time) {
    const double w = std::sqrt(stiffness / 2), c = std::cos(w * time), s = std::sin(w * time);
    return (Eigen::Matrix2d() << c, s / w, -w * s, c).finished();
  };
  const double low = 5e4 * (1 - 0.6 * 0.3), high = low + 0.6 * 5e4;
  const Eigen::Matrix2d cycle = piece(high, 0.1 / 70) * piece(low, 0.7 / 70) * piece(high, 0.2 / 70);
  Eigen::Vector2d expected(1e-3, 0.1);
  for (int i = 0; i < 30; ++i) expected = cycle * expected;
  for (const auto method : adaptive) {
    auto workspace = system.workspace();
    auto state = start(1e-3, 0.1);
    const auto statistics = integrate(system, state, 30.0 / 70, tight(method, 1e-9, 1e-12), workspace);
    BOOST_TEST(statistics.stiffness_restarts == 60);
    const double scale = expected.norm(), bound = 2e-9 * static_cast<double>(statistics.steps);
    record.at_most("state after 30 cycles: error over its size", "",
                   std::hypot((state.q[0] - expected[0]) * 158, state.v[0] - expected[1]) / scale, bound,
                   "steps x tolerance of the integrator");
  }
}

BOOST_AUTO_TEST_CASE(samples_lie_on_the_solution) {
  annulus::test::Verification record("Samples between the steps of an integrator", "closed form: x0 cos w t");
  const auto system = Oscillator{}.system();
  const double w = std::sqrt(2.5e4);
  for (const auto method : adaptive) {
    auto workspace = system.workspace();
    auto state = start(1e-3, 0);
    int count = 0;
    double worst = 0;
    integrate(system, state, 0.1, tight(method, 1e-8, 1e-11), workspace,
              {.samples = 97, .sample = [&](int i, const SystemState& s) {
                 BOOST_TEST(i == count);
                 BOOST_TEST(std::abs(s.time - 0.1 * i / 97) <= 1e-15);
                 worst = std::max(worst, std::abs(s.q[0] - 1e-3 * std::cos(w * s.time)));
                 ++count;
               }});
    BOOST_TEST(count == 97);
    // Interpolation between steps is of lower order than the steps: a hundred times the tolerance x steps (about 200).
    record.at_most("largest error of 97 samples", "m", worst, 1e-3 * 1e-8 * 2e4,
                   "100 x steps x tolerance: interpolation is of lower order");
  }
}

/// A stage without loss and load in which every DOF moves.
SystemState shaken(const LumpedSystem& system) {
  SystemState state;
  state.q.setZero(system.dofs());
  state.v.resize(system.dofs());
  for (int i = 0; i < system.dofs(); ++i) state.v[i] = 0.1 * std::sin(1.0 + 7.0 * i);
  return state;
}

BOOST_AUTO_TEST_CASE(undamped_unforced_energy_is_constant) {
  annulus::test::Verification record("Energy of a rattling stage without losses and load",
                                     "conservation of energy, also in the turning frame");
  for (const double speed : {0.0, 300.0}) {  // with the conservative terms of the rotating frame
    auto stage = stages::ring_paper();
    stage.planet_errors.clear();
    stage.sun_torque = 0;
    stage.mesh_damping_ratio = stage.support_damping_ratio = 0;
    stage.set_half_backlash(2e-6);  // contacts open and close all the time
    stage.sun_mesh = ConstantStiffness{1.364e9};
    stage.ring_mesh = ConstantStiffness{1.87e9};
    stage.carrier_speed = speed;
    const auto system = assemble(stage);
    for (const auto method : {Integrator::arkode_explicit, Integrator::cvode_adams}) {
      auto workspace = system.workspace();
      auto state = shaken(system);
      Eigen::VectorXd y(2 * system.dofs());
      y << state.q, state.v;
      system.detect_contact(0, y.data(), workspace);
      const double before = system.energy(0, y.data(), workspace);
      const double tolerance = 1e-8;
      const auto statistics = integrate(system, state, 0.01, tight(method, tolerance, 1e-5 * tolerance), workspace);
      y << state.q, state.v;
      const double after = system.energy(state.time, y.data(), workspace);
      BOOST_TEST(statistics.contact_events > 10);
      // Each step errs by at most about the tolerance in every DOF; energy is quadratic: 2 x steps x tolerance.
      record.near(speed > 0 ? "energy, carrier at 300 rad/s" : "energy, carrier at rest", "J", after, before,
                  2 * tolerance * static_cast<double>(statistics.steps) * before,
                  "2 x steps x tolerance of the integrator");
    }
  }
}

BOOST_AUTO_TEST_CASE(energy_bookkeeping_closes_with_everything_acting) {
  annulus::test::Verification record("Energy of a stage with everything acting",
                                     "first law: change of energy = supplied work - dissipated work");
  auto stage = stages::ring_paper();
  stage.sun_mesh = RectangularStiffness{1.364e9, 0.35, 0.6, 0};
  stage.sun_torque = 2000;  // light enough for the meshes to part
  stage.set_half_backlash(5e-6);
  stage.mesh_damping_ratio = 0.02;
  const auto system = assemble(stage);
  for (const auto method : adaptive) {
    auto workspace = system.workspace();
    auto state = shaken(system);
    Eigen::VectorXd y(2 * system.dofs());
    y << state.q, state.v;
    system.hold_waves(1e-9, workspace);
    system.detect_contact(0, y.data(), workspace);
    const double before = system.energy(0, y.data(), workspace);
    const auto statistics = integrate(system, state, 10 / stage.mesh_frequency(), tight(method, 1e-8, 1e-13), workspace,
                                      {.energy = EnergyTracking::on});
    y << state.q, state.v;
    const double after = system.energy(state.time, y.data(), workspace);
    BOOST_TEST(statistics.contact_events > 10);
    BOOST_TEST(statistics.stiffness_restarts >= 49);  // phases of 0.2 cycles and a duty of 0.6: five a cycle
    BOOST_TEST(state.dissipated > 0.1 * before);
    // Local errors, as above, of the larger of the energies that pass.
    const double scale = before + state.dissipated + std::abs(state.supplied);
    record.near("change of energy", "J", after - before, state.supplied - state.dissipated,
                2e-8 * static_cast<double>(statistics.steps) * scale,
                "2 x steps x tolerance of the integrator x energies that pass");
  }
}

BOOST_AUTO_TEST_CASE(all_integrators_agree_on_a_rattling_stage) {
  annulus::test::Verification record("Four integrators on a stage whose teeth lose contact",
                                     "each other: explicit Runge-Kutta, Adams, BDF, fixed-step Runge-Kutta");
  auto stage = stages::ring_paper();
  stage.sun_torque = 2000;
  stage.set_half_backlash(5e-6);
  const auto system = assemble(stage);
  std::vector<Eigen::VectorXd> ends;
  long events = 0;
  for (const auto method :
       {Integrator::arkode_explicit, Integrator::cvode_adams, Integrator::cvode_bdf, Integrator::runge_kutta_4}) {
    auto workspace = system.workspace();
    auto state = shaken(system);
    auto options = tight(method, 1e-9, 1e-15);
    if (method == Integrator::runge_kutta_4) options.fixed_step = 2e-7;
    events = integrate(system, state, 3 / stage.mesh_frequency(), options, workspace).contact_events;
    ends.push_back(state.q);
  }
  BOOST_TEST(events > 10);
  // Deflections are some 1e-5 m; contact events amplify the integrators' 1e-9 differences by less than a thousand in
  // three mesh cycles.
  for (const auto& end : ends)
    record.at_most("largest difference of a degree of freedom after three mesh cycles", "m",
                   (end - ends[0]).cwiseAbs().maxCoeff(), 1e-11,
                   "tolerance 1e-9 of 1e-5 m, amplified up to a thousand times by contact events");
}

// A linear stage (teeth always touching) under the planets' eccentricity, gyroscopic terms and dampers included,
// against the solution of the complex linear system at that frequency.
BOOST_AUTO_TEST_CASE(forced_response_agrees_with_the_frequency_domain) {
  annulus::test::Verification record("Forced vibration of a turning stage by the eccentricity of its planets",
                                     "complex linear system at that frequency, solved directly");
  auto stage = stages::ring_paper();
  stage.set_half_backlash({});
  stage.sun_mesh = ConstantStiffness{1.364e9};
  stage.ring_mesh = ConstantStiffness{1.87e9};
  stage.carrier_speed = 200;  // errors at 589 rad/s, near the sun on its support; rotating terms of some per cent
  const auto system = assemble(stage);
  const int n = system.dofs();
  const double w = 200.0 * 162 / 55;

  Eigen::MatrixXd stiffness = system.stiffness() + system.rotating_stiffness();
  Eigen::MatrixXd damping = system.damping() + system.gyroscopic();
  Eigen::VectorXd constant = system.load();
  Eigen::VectorXcd harmonic = Eigen::VectorXcd::Zero(n);
  using namespace std::complex_literals;
  std::vector<std::complex<double>> amplitude;  // e = constant part + Re(amplitude exp(i w t))
  std::vector<double> offset, mean;
  for (int m = 0; m < 10; ++m) {
    const auto& mesh = system.meshes()[m];
    const Eigen::VectorXd b = system.mesh_vector(m);
    mean.push_back(m < 5 ? 1.364e9 : 1.87e9);
    amplitude.push_back(0);
    offset.push_back(0);
    for (const auto& e : mesh.errors) {
      if (e.rate == 0) {
        offset.back() += e.amount * std::sin(e.phase);
      } else {
        BOOST_REQUIRE(std::abs(e.rate + w) < 1e-9);
        amplitude.back() += e.amount * 1i * std::exp(-1i * e.phase);  // sin(-w t + p) = Re(i e^{i(wt - p)})
      }
    }
    stiffness += mean[m] * b * b.transpose();
    damping += mesh.damping * b * b.transpose();
    constant += mean[m] * offset[m] * b;
    harmonic += (mean[m] + 1i * w * mesh.damping) * amplitude[m] * b;
  }
  // The rigid rotation is neutral: held at its start for the static part, unexcited by the harmonic one.
  const Eigen::MatrixXcd dynamic = stiffness - w * w * system.mass() + 1i * w * damping;
  const Eigen::VectorXcd q = dynamic.partialPivLu().solve(harmonic);
  const Eigen::VectorXd q0 = stiffness.completeOrthogonalDecomposition().solve(constant);

  SystemState state;
  state.q = q0 + q.real();
  state.v = (1i * w * q).real();
  auto workspace = system.workspace();
  double worst = 0, swing = 0;
  annulus::test::RecordedPlot::Curve first{"", {}, {}, {}};
  const auto compare = [&](int i, const SystemState& s) {
    const std::complex<double> turn = std::exp(1i * w * s.time);
    for (int m = 0; m < 10; ++m) {
      const Eigen::VectorXd b = system.mesh_vector(m);
      const auto delta = (b.cast<std::complex<double>>().dot(q) - amplitude[m]) * turn;
      const double vibration = (delta * (mean[m] + 1i * w * system.meshes()[m].damping)).real();
      const double force = mean[m] * (b.dot(q0) - offset[m]) + vibration;
      worst = std::max(worst, std::abs(workspace.force[m] - force));
      swing = std::max(swing, std::abs(vibration));
      if (m > 0 || i > 40) continue;
      first.x.push_back(s.time * 1e3);
      first.computed.push_back(workspace.force[m] * 1e-3);
      first.reference.push_back(force * 1e-3);
    }
  };
  // Started on the periodic solution, the stage stays on it: ten periods.
  integrate(system, state, 20 * std::numbers::pi / w, tight(Integrator::arkode_explicit, 1e-9, 1e-14), workspace,
            {.samples = 200, .sample = compare});
  BOOST_TEST(swing > 1000);  // N: the vibration is there
  record.at_most("largest error of a mesh force in ten periods, over the mean force", "",
                 worst / stage.mean_mesh_force(), 1e-5, "integrator: 1e4 steps of 1e-9");
  record.plot({"Force on the first sun mesh", "time, ms", "kN", {first}});
}

// A body on spring and damper in the housing does not know that it is watched from a turning frame: its damped free
// vibration, turned back by Omega t, is the answer. Every sign of the rotating-frame terms enters.
BOOST_AUTO_TEST_CASE(the_turning_frame_changes_nothing_physical) {
  annulus::test::Verification record("A body in the housing, watched from a turning frame",
                                     "closed form: damped free vibration, turned back");
  const double mass = 2, stiffness = 5e4, damping = 40, speed = 90, t = 0.15;
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("x"), y = builder.add_dof("y");
  builder.add_rotating_mass(x, y, mass, speed);
  for (const auto& direction : {x, y}) builder.add_spring(direction, stiffness, damping);
  builder.add_housing_damper_rotation(x, y, damping, speed);
  const auto system = builder.build();
  // In the housing: position (1, 0) mm, velocity (0, 0.2) m/s.
  const Eigen::Vector2d position(1e-3, 0), velocity(0, 0.2);
  SystemState state;
  state.q = position;
  state.v = velocity - speed * Eigen::Vector2d(-position[1], position[0]);
  auto workspace = system.workspace();
  const auto statistics = integrate(system, state, t, tight(Integrator::arkode_explicit, 1e-9, 1e-12), workspace,
                                    {.energy = EnergyTracking::on});
  const double decay = damping / (2 * mass), w = std::sqrt(stiffness / mass - decay * decay);
  const Eigen::Vector2d housing = std::exp(-decay * t) * (position * (std::cos(w * t) + decay / w * std::sin(w * t)) +
                                                          velocity * std::sin(w * t) / w);
  const double c = std::cos(speed * t), s = std::sin(speed * t);
  const Eigen::Vector2d expected(c * housing[0] + s * housing[1], -s * housing[0] + c * housing[1]);
  record.at_most("distance from the expected place after 0.15 s", "m", (state.q - expected).norm(),
                 2e-9 * 1e-3 * static_cast<double>(statistics.steps), "steps x tolerance of the integrator");
}

BOOST_AUTO_TEST_CASE(failures_are_reported) {
  const annulus::UntrappedFloatingPoint untrapped;  // an unstable step overflows
  const auto system = Oscillator{}.system();
  auto workspace = system.workspace();
  auto state = start(1e-3, 0);
  auto options = tight(Integrator::arkode_explicit, 1e-6, 1e-9);
  options.max_steps = 2;
  BOOST_CHECK_THROW(integrate(system, state, 1, options, workspace), annulus::SolverError);
  options = {};
  BOOST_CHECK_THROW(integrate(system, state, 1, options, workspace), annulus::InputError);  // no scale for a tolerance
  options = tight(Integrator::runge_kutta_4, 1e-6, 1e-9);
  BOOST_CHECK_THROW(integrate(system, state, 1, options, workspace), annulus::InputError);  // no step
  options = tight(Integrator::cvode_bdf, 0, 1e-9);
  BOOST_CHECK_THROW(integrate(system, state, 1, options, workspace), annulus::InputError);
  options = tight(Integrator::cvode_bdf, 1e-6, 1e-9);
  BOOST_CHECK_THROW(integrate(system, state, 0, options, workspace), annulus::InputError);  // ends at its start
  // An unstable fixed step ends in an error, not in infinities.
  options = tight(Integrator::runge_kutta_4, 1e-6, 1e-9);
  options.fixed_step = 1;
  BOOST_CHECK_THROW(integrate(system, state, 1000, options, workspace), annulus::SolverError);
}

BOOST_AUTO_TEST_SUITE_END()
