#include "dynamics/systems/planetary/response.h"

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrate.h"
#include "stages.h"
#include "tests/verification_record.h"

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double mass_1 = 0.3, mass_2 = 0.9, mean = 2e8, ripple = 0.8, duty = 0.4;

/// Two gears free to turn, a rectangular mesh stiffness between them: one elastic and one rigid motion.
LumpedSystem gear_pair(double frequency, double damping) {
  LumpedSystemBuilder builder;
  const auto u = builder.add_dof("u1"), v = builder.add_dof("u2");
  builder.add_mass(u, mass_1);
  builder.add_mass(v, mass_2);
  MeshElement mesh;
  mesh.name = "pair";
  mesh.b = u + v;
  mesh.excitation = RectangularStiffness{mean, ripple, duty, 0};
  mesh.frequency = frequency;
  mesh.damping = damping;
  mesh.half_backlash = 1e-3;
  builder.add_mesh(mesh);
  builder.add_load(u, 1000);
  builder.add_load(v, 1000);
  return builder.build();
}

constexpr double pair_mass = mass_1 * mass_2 / (mass_1 + mass_2);

/// Transfer of (x, x') over a time at one stiffness: m x'' + c x' + k x = 0, underdamped.
Eigen::Matrix2d oscillator(double k, double c, double time) {
  const double decay = c / (2 * pair_mass), w = std::sqrt(k / pair_mass - decay * decay), e = std::exp(-decay * time);
  const double cosine = std::cos(w * time), sine = std::sin(w * time);
  return e * Eigen::Matrix2d{{cosine + decay / w * sine, sine / w},
                             {-(w + decay * decay / w) * sine, cosine - decay / w * sine}};
}

struct LoadSharingPair {
  double sun, ring;
};

LoadSharingPair load_sharing(const PiecewiseResponse& r) {
  const auto largest = [&](const auto& rows) {
    return std::max({load_sharing_instantaneous(rows(r.force)), load_sharing_instantaneous(rows(r.force_before)),
                     load_sharing_instantaneous(rows(r.force_after))});
  };
  return {largest([](const Eigen::MatrixXd& f) { return f.topRows(3); }),
          largest([](const Eigen::MatrixXd& f) { return f.bottomRows(3); })};
}

/// Largest difference of the mesh forces to a time integration of tight tolerance from the exact state, over one period
/// / mean.
double difference_to_time_integration(const PlanetaryStage& stage, const PiecewiseResponse& exact, double tolerance) {
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  SystemState state{0, exact.displacement.col(0), exact.velocity.col(0)};
  IntegratorOptions options;
  options.method = Integrator::arkode_explicit;
  options.relative_tolerance = tolerance;
  options.absolute_tolerance = tolerance * 1e-7;  // deflections are some 1e-6 m
  double difference = 0;
  integrate(system, state, exact.solved_cycles / stage.mesh_frequency(), options, workspace,
            {.samples = static_cast<int>(exact.time.size()), .sample = [&](int i, const SystemState&) {
               for (Eigen::Index m = 0; m < exact.force.rows(); ++m)
                 difference = std::max(difference, std::abs(workspace.force[m] - exact.force(m, i)));
             }});
  return difference / stage.mean_mesh_force();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(piecewise_responses)

// Meissner's equation, Hill's with a rectangular stiffness: the trace of the monodromy matrix without damping is
// 2 cos a cos b - (w1/w2 + w2/w1) sin a sin b, a and b the phases of both parts; the motion is unstable where it lies
// outside -2 ... 2. With damping against the product of both known transfer matrices.
BOOST_AUTO_TEST_CASE(floquet_multipliers_of_a_gear_pair_are_those_of_meissners_equation) {
  const double high = mean * (1 + ripple * (1 - duty)), low = mean * (1 - ripple * duty);
  const double w1 = std::sqrt(high / pair_mass), w2 = std::sqrt(low / pair_mass);
  const double natural = std::sqrt(mean / pair_mass) / (2 * std::numbers::pi);
  test::Verification record("Stability of a gear pair with rectangular stiffness (Floquet multipliers)",
                            "Meissner's equation: trace of the monodromy matrix 2 cos a cos b - (w1/w2 + w2/w1) sin a "
                            "sin b; damped: product of both transfer matrices");
  test::RecordedPlot::Curve undamped_curve{"undamped", {}, {}, {}}, damped_curve{"damping ratio 0.05", {}, {}, {}};
  int stable = 0, unstable = 0;
  for (double ratio = 0.35; ratio < 2.6; ratio += 0.05) {
    const double period = 1 / (ratio * natural), a = w1 * duty * period, b = w2 * (1 - duty) * period;
    const double half_trace = std::cos(a) * std::cos(b) - 0.5 * (w1 / w2 + w2 / w1) * std::sin(a) * std::sin(b);
    const double expected =
        std::abs(half_trace) > 1 ? std::abs(half_trace) + std::sqrt(half_trace * half_trace - 1) : 1.0;
    const auto r = piecewise_response(gear_pair(1 / period, 0), period, 1);
    // Multipliers at the edge of instability are double: the root of the rounding there, away from it rounding.
    const double sensitivity = 1 / std::sqrt(std::max(std::abs(half_trace * half_trace - 1), 1e-6));
    record.near("largest multiplier, undamped", "", *r.largest_multiplier, expected, 1e-12 * sensitivity * expected,
                "rounding; its root at the edge of instability, where multipliers are double");
    undamped_curve.x.push_back(ratio);
    undamped_curve.computed.push_back(*r.largest_multiplier);
    undamped_curve.reference.push_back(expected);
    BOOST_TEST(r.stable == (expected < 1 + 1e-9));
    ++(std::abs(half_trace) > 1 ? unstable : stable);

    const double damping = 2 * 0.05 * std::sqrt(mean * pair_mass);
    const Eigen::Matrix2d map =
        oscillator(low, damping, (1 - duty) * period) * oscillator(high, damping, duty * period);
    const std::complex<double> root =
        std::sqrt(std::complex<double>(map.trace() * map.trace() / 4 - map.determinant()));
    const double damped = std::max(std::abs(map.trace() / 2 + root), std::abs(map.trace() / 2 - root));
    const auto d = piecewise_response(gear_pair(1 / period, damping), period, 1);
    record.near("largest multiplier, damping ratio 0.05", "", *d.largest_multiplier, damped, 1e-9 * damped,
                "rounding of the eigenvalues");
    damped_curve.x.push_back(ratio);
    damped_curve.computed.push_back(*d.largest_multiplier);
    damped_curve.reference.push_back(damped);
    BOOST_TEST((d.trouble.find("parametric resonance") != std::string::npos) == (damped > 1 + 1e-9));
  }
  BOOST_TEST(stable > 10);
  BOOST_TEST(unstable > 3);
  record.plot({"Largest Floquet multiplier", "mesh over natural frequency", "", {undamped_curve, damped_curve}});
}

// x'' m + c x' + k x = F with both transfer matrices: x0 = (I - M)^-1 (particular part), a two by two problem.
BOOST_AUTO_TEST_CASE(force_of_a_gear_pair_has_its_closed_form) {
  test::Verification record("Periodic force of a gear pair with rectangular stiffness",
                            "closed form: both transfer matrices, a two by two problem");
  const double high = mean * (1 + ripple * (1 - duty)), low = mean * (1 - ripple * duty);
  const double period = 2e-3, damping = 2 * 0.05 * std::sqrt(mean * pair_mass);
  const double load = pair_mass * (1000 / mass_1 + 1000 / mass_2);
  const Eigen::Matrix2d first = oscillator(high, damping, duty * period),
                        second = oscillator(low, damping, (1 - duty) * period);
  const Eigen::Vector2d rest_1(load / high, 0), rest_2(load / low, 0);
  // Deviations from the equilibrium of each part decay by its transfer matrix.
  const Eigen::Vector2d constant = rest_2 - second * rest_2 + second * (rest_1 - first * rest_1);
  const Eigen::Vector2d x = (Eigen::Matrix2d::Identity() - second * first).inverse() * constant;
  const auto r = piecewise_response(gear_pair(1 / period, damping), period, 1);
  BOOST_TEST(r.stable);  // the teeth would part; the linear solution is compared
  BOOST_TEST(r.residual <= 1e-12);
  record.close("force after the jump", "N", r.force(0, 0), high * x[0] + damping * x[1], 1e-11, "rounding");
  record.close("force before the jump", "N", r.force_before(0, 0), low * x[0] + damping * x[1], 1e-11, "rounding");
  // The rigid motion stands still: no momentum, its mean place at zero.
  BOOST_TEST(std::abs(mass_1 * r.velocity(0, 0) - mass_2 * r.velocity(1, 0)) <=
             1e-11 * mass_1 * std::max(1e-3, r.velocity.cwiseAbs().maxCoeff()));
  const Eigen::VectorXd place = mass_1 * r.displacement.row(0) - mass_2 * r.displacement.row(1);
  BOOST_TEST(std::abs(place.mean()) <= 1e-15);
}

// Theorem (docs/backlash_optimisation.md): moving every body by its part of the gap leaves equations without backlash,
// and without errors these scale with the torque.
BOOST_AUTO_TEST_CASE(load_sharing_depends_on_neither_backlash_nor_torque_while_no_mesh_separates) {
  test::Verification record("Load sharing without errors depends on neither backlash nor torque",
                            "theorem: each body moved by its part of the gap leaves equations without backlash, which "
                            "scale with the torque");
  auto stage = stages::backlash_paper();
  const auto reference = load_sharing(piecewise_response(stage));
  BOOST_TEST(reference.sun > 1.1);
  for (const double sun_half : {10e-6, 1e-3})
    for (const double ring_half : {10e-6, 1e-3})
      for (const double torque : {5.0, 500.0}) {
        stage.sun_half_backlash = sun_half;
        stage.ring_half_backlash = ring_half;
        stage.sun_torque = torque;
        const auto r = piecewise_response(stage);
        BOOST_TEST(r.converged);
        const auto l = load_sharing(r);
        record.near("load sharing coefficient, sun meshes", "", l.sun, reference.sun, 1e-10, "rounding");
        record.near("load sharing coefficient, ring meshes", "", l.ring, reference.ring, 1e-10, "rounding");
      }
  // Time integration shows it too. It carries the gap (up to 1 mm) in its displacements: rounding of a deflection of
  // 1e-6 m and a tolerance of 1e-9 of it leave some 1e-7.
  SimulationOptions options;
  options.steady_state = SteadyState::time_integration;
  options.integrator.relative_tolerance = 1e-9;
  options.integrator.absolute_tolerance = 1e-16;
  options.steady_tolerance = 1e-8;
  options.estimate_error = false;
  stage.sun_torque = 50;
  for (const double half : {10e-6, 1e-3}) {
    stage.set_half_backlash(half);
    const auto r = simulate(stage, options);
    BOOST_TEST(r.steady);
    // 1e-3 by the exact solution's peaks, looked for between the samples here: the jump itself is exact.
    record.near("load sharing coefficient, sun meshes, time integration", "",
                r.sun_planet.load_sharing.instantaneous.value, reference.sun, 1e-6,
                "integrator: 1e-9 of some 1e-6 m beside a gap of 1 mm");
  }
}

BOOST_AUTO_TEST_CASE(time_integration_at_tight_tolerance_follows_the_exact_response) {
  test::Verification record("Exact response to jumping stiffness of the backlash paper's stage",
                            "time integration by ARKODE, tolerance 1e-10");
  auto stage = stages::backlash_paper();
  const double plain = difference_to_time_integration(stage, piecewise_response(stage), 1e-10);
  record.at_most("largest difference of a mesh force over the mean, no errors", "", plain, 1e-7,
                 "tolerance x steps of a period");
  // With errors of every kind that turn: sine and cosine as part of the state; period z_p.
  stage.planet_errors = {{{3e-6, 0.3}, {2e-6, 1}}, {{1e-6, 2}, {}}, {}};
  const auto r = piecewise_response(stage, 16);
  BOOST_TEST(r.solved_cycles == 39);
  BOOST_TEST(r.converged);
  record.at_most("largest difference of a mesh force over the mean, errors that turn", "",
                 difference_to_time_integration(stage, r, 1e-10), 1e-6, "tolerance x steps of 39 mesh cycles");
}

BOOST_AUTO_TEST_CASE(contact_loss_and_parametric_resonance_are_reported) {
  test::Verification record(
      "Exact solutions that would pull or do not last",
      "sign of the sampled forces; time integration, in which a disturbance grows until contact is lost");
  auto stage = stages::backlash_paper();
  const double base = stage.carrier_speed;
  stage.carrier_speed = base * 5250 / 1500;
  const auto separating = piecewise_response(stage);
  BOOST_TEST(separating.solved);
  BOOST_TEST(separating.stable);
  record.at_most("least penetration with loss of contact", "m", separating.least_penetration, 0, "its sign");
  BOOST_TEST(separating.least_penetration < 0);
  BOOST_TEST(!separating.converged);
  // The sampled forces of the solution agree with the sign of the penetration: it would pull.
  record.at_most("least sampled force with loss of contact", "N", separating.dense_force.minCoeff(), 0, "its sign");
  BOOST_TEST(separating.dense_force.minCoeff() < 0);
  stage.carrier_speed = base * 20700 / 1500;
  const auto unstable = piecewise_response(stage);
  BOOST_TEST(!unstable.stable);
  record.at_least("least penetration at a parametric resonance", "m", unstable.least_penetration, 0, "its sign");
  BOOST_TEST(unstable.least_penetration > 0);
  BOOST_TEST(unstable.trouble.find("parametric resonance") != std::string::npos);
  // So does time integration: a small disturbance grows until contact is lost.
  SimulationOptions options;
  options.mesh_cycles = 400;
  const auto integrated = simulate(stage, options);
  record.at_least("contact events in the time integration there", "",
                  static_cast<double>(integrated.statistics.contact_events), 1, "the disturbance grows");
}

BOOST_AUTO_TEST_CASE(simulation_takes_the_exact_solution_and_confirms_it) {
  test::Verification record("Load sharing of a simulation with jumping stiffness", "the exact piecewise solution");
  auto stage = stages::backlash_paper();
  // No jump stands on a sample.
  stage.sun_mesh = RectangularStiffness{4.5e8, 0.35, 0.6, 0.003};
  stage.ring_mesh = RectangularStiffness{5.5e8, 0.25, 0.6, 0.003};
  const auto r = simulate(stage);
  BOOST_REQUIRE(r.periodic.has_value());
  BOOST_TEST((r.periodic->method == PeriodicMethod::piecewise));
  BOOST_TEST(r.confirmed);
  BOOST_TEST(*r.steady_difference <= 1e-4);
  SimulationOptions alone;
  alone.confirmation = Confirmation::never;
  const auto exact = simulate(stage, alone);
  const auto reference = load_sharing(piecewise_response(stage));
  // The extreme of the sun meshes stands at a jump: no sample sees it, both ways of solving do.
  const auto& sharing = exact.sun_planet.load_sharing.instantaneous;
  record.close("instantaneous coefficient, sun meshes", "", sharing.value, reference.sun, 1e-9, "rounding");
  BOOST_TEST(sharing.value > load_sharing_instantaneous(exact.series.force.topRows(3)));
  record.close("the same, confirmed by time integration", "", r.sun_planet.load_sharing.instantaneous.value,
               sharing.value, 1e-5, "tolerance of the integrator");
}

BOOST_AUTO_TEST_CASE(averages_take_each_side_of_a_jump_up_to_it) {
  test::Verification record("Mean of a sampled force that jumps", "closed form: square wave, 1 + 2 x 0.37");
  // A square wave, 3 from 0 to 0.37 and 1 behind, over two cycles of ten samples: the mean is 1 + 2 x 0.37.
  ResponseWindow window;
  window.samples_per_cycle = 10;
  window.time = Eigen::VectorXd::LinSpaced(20, 0, 1.9);
  window.force.resize(1, 20);
  for (int i = 0; i < 20; ++i) window.force(0, i) = i % 10 < 3.7 ? 3 : 1;
  BOOST_TEST(std::abs(window.force.mean() - 1.74) > 0.05);
  window.jump_time = Eigen::Vector4d{0, 0.37, 1, 1.37};
  window.force_before = Eigen::RowVector4d{1, 3, 1, 3};
  window.force_after = Eigen::RowVector4d{3, 1, 3, 1};
  const Eigen::MatrixXd force = averaging_force(window);
  record.close("mean over a cycle of ten samples", "", force.leftCols(10).mean(), 1.74, 1e-12, "rounding");
  BOOST_TEST(force.mean() == 1.74, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(equal_planets_share_equally_on_average) {
  test::Verification record("Averaged load sharing of equal planets without errors",
                            "symmetry: all carry the same over a mesh cycle");
  // Without errors planet n does what planet 1 does a third of a mesh cycle off: over a whole cycle all carry the same.
  // So exactly, and integrated for a hundred cycles with loss of contact: there jumps come late in time.
  for (const double speed : {1.0, 5200.0 / 1500}) {
    auto stage = stages::backlash_paper();
    stage.carrier_speed *= speed;
    for (const int samples : {64, 128}) {
      SimulationOptions options;
      options.samples_per_cycle = samples;
      const auto r = simulate(stage, options);
      BOOST_TEST(r.steady);
      BOOST_TEST((r.periodic->converged == (speed == 1)));
      for (const auto* kind : {&r.sun_planet, &r.ring_planet}) {
        const auto& averaged = kind->load_sharing.averaged;
        BOOST_TEST(averaged.value >= 1 - 1e-12);
        BOOST_TEST(averaged.value - 1 <= averaged.error, samples << ": " << averaged.value << " +- " << averaged.error);
        // A plain mean of the samples is wrong by 2e-3 here.
        record.near("averaged load sharing coefficient", "", averaged.value, 1, 4e-4,
                    "a fifth of what a plain mean of the samples misses");
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(other_systems_are_refused_with_the_reason) {
  auto stage = stages::backlash_paper();
  stage.sun_mesh = HarmonicStiffness{4.5e8, 0.2, 0};
  const auto r = piecewise_response(stage);
  BOOST_TEST(!r.solved);
  BOOST_TEST(r.trouble.find("changes continuously") != std::string::npos);
  const auto system = assemble(stages::backlash_paper());
  BOOST_TEST(why_not_piecewise(system, 1.3 / stages::backlash_paper().mesh_frequency()) != "");
}

BOOST_AUTO_TEST_SUITE_END()
