#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <ctime>
#include <numbers>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrate.h"
#include "dynamics/time_integration/integrator_choice.h"
#include "tests/dynamics/stages.h"

BOOST_AUTO_TEST_SUITE(extreme_motions)

using namespace annulus;
using namespace annulus::dynamics;

std::vector<double> all_frequencies(const PlanetaryStage& stage) {
  std::vector<double> list;
  for (const auto& mode : annulus::dynamics::modes(stage).modes) list.push_back(mode.frequency);
  return list;
}

PlanetaryStage with_supports(double k) {
  auto stage = stages::ring_paper();
  stage.sun.support = stage.ring.support = stage.carrier.support = k;
  stage.planet_bearings = {{k, k}};
  stage.ring.torsional_support = k;
  return stage;
}

// What is left of a DOF under 1e15 N/m moves by (meshes / support) of what meshes do: 5 x 1.9e9 / 1e15 at most.
BOOST_AUTO_TEST_CASE(stiff_supports_tend_to_dropped_dofs) {
  const auto held = all_frequencies(with_supports(rigid));
  for (const double k : {1e13, 1e14, 1e15}) {
    const auto stiff = all_frequencies(with_supports(k));
    BOOST_TEST(stiff.size() > held.size());
    for (std::size_t i = 0; i < held.size(); ++i) BOOST_TEST(std::abs(stiff[i] - held[i]) <= 1e10 / k * held[i]);
  }
  BOOST_TEST(held.front() == 0);
}

// Two masses of 1 kg, one on 1 N/m, the other on it by 1e15 N/m: sqrt(1/2) and sqrt(2e15) rad/s.
BOOST_AUTO_TEST_CASE(soft_supports_are_kept_beside_stiff_ones) {
  LumpedSystemBuilder builder;
  const auto one = builder.add_dof("one"), other = builder.add_dof("other");
  builder.add_mass(one, 1);
  builder.add_mass(other, 1);
  builder.add_spring(one, 1, 0);
  builder.add_spring(one + (-1.0) * other, 1e15, 0);
  const auto found = annulus::dynamics::modes(builder.build(), {});
  // Rounding: 1e-15 of the highest, 6e-8 of the lowest. Squares would leave 0.2 (rad/s)^2 of 0.5.
  BOOST_TEST(std::abs(2 * std::numbers::pi * found.modes[0].frequency - std::sqrt(0.5)) <= 1e-6);
  BOOST_TEST(std::abs(2 * std::numbers::pi * found.modes[1].frequency / std::sqrt(2e15) - 1) <= 1e-12);
}

// Two rotations (carrier and ring choose, sun and planets follow) and two translations of sun, ring and carrier against
// each other, of three, that turning planets make up for: each in two directions.
BOOST_AUTO_TEST_CASE(free_bodies_have_motions_of_exactly_no_frequency) {
  auto stage = with_supports(1e15);
  stage.ring.torsional_support = 0;
  for (auto* body : {&stage.sun, &stage.ring, &stage.carrier}) body->support = 0;
  const auto frequencies = all_frequencies(stage);
  for (std::size_t i = 0; i < 6; ++i) BOOST_TEST(frequencies[i] == 0);
  BOOST_TEST(frequencies[6] > 100);
}

enum class Scaled { mass, stiffness };

/// The stage with time in other units: a second becomes `unit`. Masses grow with its square, or stiffness, forces and
/// loads fall with it.
PlanetaryStage in_time_unit(double unit, Scaled scaled) {
  auto stage = stages::ring_paper();
  const double square = unit * unit;
  stage.carrier_speed /= unit;
  if (scaled == Scaled::mass) {
    for (auto* body : {&stage.sun, &stage.ring, &stage.carrier}) body->mass *= square, body->inertia *= square;
    stage.planet.mass *= square, stage.planet.inertia *= square;
    return stage;
  }
  for (auto* body : {&stage.sun, &stage.ring, &stage.carrier})
    body->support /= square, body->torsional_support /= square;
  for (auto& bearing : stage.planet_bearings) bearing.radial /= square, bearing.tangential /= square;
  stage.sun_mesh = HarmonicStiffness{1.364e9 / square, 0.2258, 0};
  stage.ring_mesh = HarmonicStiffness{1.87e9 / square, 0.1294, 0};
  stage.sun_torque /= square;
  return stage;
}

BOOST_AUTO_TEST_CASE(any_unit_of_time_gives_the_same_answer) {
  const auto nominal = stages::ring_paper();
  const auto frequencies = all_frequencies(nominal);
  const auto path = quasi_static(nominal, 16, 2000);
  int exponent = 0;
  for (const bool light : {false, true}) {
    auto options = SimulationOptions{};
    auto reference = nominal;
    if (light) {
      // Teeth part: contact events at times that rounding moves. A few cycles, before chaos has multiplied it.
      reference.sun_torque /= 50;
      options.mesh_cycles = 6;
      options.integrator.relative_tolerance = 1e-9;
    }
    const auto answer = simulate(reference, options);
    if (light) BOOST_TEST(answer.statistics.contact_events > 0);
    // A power of two multiplies without rounding: what is left of the difference is what depends on the unit.
    for (const double unit : {1e-6, 1e6, std::ldexp(1.0, -20), std::ldexp(1.0, 20)})
      for (const auto scaled : {Scaled::stiffness, Scaled::mass}) {
        auto stage = in_time_unit(unit, scaled);
        if (light) stage.sun_torque /= 50;
        const double force = scaled == Scaled::mass ? 1 : unit * unit;
        if (!light) {
          const auto other = all_frequencies(stage);
          for (std::size_t i = 0; i < other.size(); ++i)
            BOOST_TEST(std::abs(other[i] * unit - frequencies[i]) <= 1e-10 * frequencies[i]);
          const auto same = quasi_static(stage, 16, 2000);
          BOOST_TEST((same.sun_force * force - path.sun_force).cwiseAbs().maxCoeff() <=
                     1e-10 * path.sun_force.cwiseAbs().maxCoeff());
        }
        const auto motion = simulate(stage, options);
        BOOST_TEST(motion.steady == answer.steady);
        BOOST_TEST(motion.total_cycles == answer.total_cycles);
        // Steps are chosen alike; rounding is magnified by the number of steps, and by contacts.
        const bool exact = std::frexp(unit, &exponent) == 0.5;
        const double limit = exact ? 1e-10 : light ? 1e-6 : 1e-7;
        BOOST_TEST((motion.series.force * force - answer.series.force).cwiseAbs().maxCoeff() <=
                   limit * answer.series.force.cwiseAbs().maxCoeff());
        BOOST_TEST(motion.energy.relative <= 10 * answer.energy.relative + 1e-9);
      }
  }
}

/// A mass (kg) on a mesh of 1e8 N/m, constant or rippled, with 700 mesh cycles a second.
LumpedSystem million_cycle_system(double mass, double damping, double ripple) {
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("x");
  mesh.excitation = ripple > 0 ? MeshExcitation(HarmonicStiffness{1e8, ripple, 0}) : ConstantStiffness{1e8};
  mesh.frequency = 700;
  mesh.damping = damping;
  mesh.half_backlash = 50e-6;
  builder.add_mass(mesh.b, mass);
  builder.add_load(mesh.b, 1000);
  builder.add_mesh(mesh);
  return builder.build();
}

// Undamped, unforced but for the static load: the energy of the vibration drifts by the local errors, whose sum is at
// most tolerance x steps, and falls with the tolerance.
BOOST_AUTO_TEST_CASE(energy_drifts_within_the_tolerance_over_a_million_mesh_cycles) {
  const double mass = 500, static_deflection = 1e-5, swing = 5e-6, stiffness = 1e8;  // a vibration in ten mesh cycles
  const auto system = million_cycle_system(mass, 0, 0);
  for (const auto& [cycles, tolerance] : {std::pair(2e4, 1e-6), std::pair(1e6, 1e-9)}) {
    IntegratorOptions options;
    options.method = Integrator::arkode_explicit;
    options.relative_tolerance = tolerance;
    options.absolute_tolerance = tolerance * 1e-6;
    SystemState state;
    state.q = Eigen::VectorXd::Constant(1, 50e-6 + static_deflection + swing);
    state.v = Eigen::VectorXd::Zero(1);
    auto workspace = system.workspace();
    const auto statistics = integrate(system, state, cycles / 700, options, workspace);
    const double x = state.q[0] - 50e-6 - static_deflection,
                 energy = mass / 2 * state.v[0] * state.v[0] + stiffness / 2 * x * x;
    const double drift = std::abs(energy / (stiffness / 2 * swing * swing) - 1);
    BOOST_TEST_MESSAGE("energy drift over " << cycles << " mesh cycles, tolerance " << tolerance << ": " << drift
                                            << " in " << statistics.steps << " steps");
    // Local errors are measured against displacements, three times the swing.
    BOOST_TEST(drift <= 3 * tolerance * static_cast<double>(statistics.steps));
    BOOST_TEST(drift <= 0.05);
  }
}

// Damped and excited, errors die as motions do: the last of 100 000 cycles balances like the two hundredth.
BOOST_AUTO_TEST_CASE(a_damped_motion_does_not_drift) {
  const auto system = million_cycle_system(5, 2 * 0.05 * std::sqrt(1e8 * 5), 0.2);
  const SteadyProblem problem{.mesh_frequency = 700, .period_in_cycles = 1, .force_scale = 1000, .stiffness = 1e8};
  SimulationOptions options;
  options.mesh_cycles = 200;
  const auto early = steady_response(system, problem, options);
  options.mesh_cycles = 100'000;
  const auto late = steady_response(system, problem, options);
  BOOST_TEST(early.steady);
  BOOST_TEST(late.steady);
  BOOST_TEST((early.best.force - late.best.force).cwiseAbs().maxCoeff() <= 1e-4 * 1000);
  BOOST_TEST(late.energy.relative <= 2 * early.energy.relative + 1e-8);
}

// The slower, the closer to the positions without inertia; vibrations need not be followed through a cycle of minutes.
BOOST_AUTO_TEST_CASE(slow_motions_tend_to_quasi_static_positions) {
  auto stage = stages::ring_paper();
  stage.carrier_speed *= 1e-5;  // 0.01 r/min of the sun
  const auto response = simulate(stage);
  BOOST_TEST(response.steady);
  BOOST_TEST((response.integrator.value().method == Integrator::arkode_implicit));
  const auto path = quasi_static(stage, SimulationOptions{}.samples_per_cycle, 2000);
  const Eigen::Index n = stage.planets();
  BOOST_TEST((response.series.force.topRows(n) - path.sun_force).cwiseAbs().maxCoeff() <=
             1e-4 * response.mean_mesh_force);
  BOOST_TEST((response.series.force.bottomRows(n) - path.ring_force).cwiseAbs().maxCoeff() <=
             1e-4 * response.mean_mesh_force);
  BOOST_TEST(response.energy.relative <= 1e-6);
  BOOST_TEST(response.force_balance_relative <= 1e-6);
}

// A light planet on stiff, lightly damped meshes: a mode hundreds of times faster than all others.
BOOST_AUTO_TEST_CASE(implicit_and_explicit_integration_agree_on_stiff_stages) {
  auto stage = stages::ring_paper();
  stage.ring.support = 1e13;
  SimulationOptions options;
  options.mesh_cycles = 30;
  options.integrator.relative_tolerance = 1e-7;
  options.integrator.method = Integrator::arkode_explicit;
  const auto followed = simulate(stage, options);
  options.integrator.method = Integrator::arkode_implicit;
  const auto stepped = simulate(stage, options);
  BOOST_TEST(stepped.statistics.steps < followed.statistics.steps);
  BOOST_TEST((stepped.series.force - followed.series.force).cwiseAbs().maxCoeff() <= 1e-4 * followed.mean_mesh_force);
  BOOST_TEST(stepped.energy.relative <= 1e-5);
}

BOOST_AUTO_TEST_CASE(unstable_fixed_steps_are_refused) {
  auto stage = stages::ring_paper();
  SimulationOptions options;
  options.mesh_cycles = 20;
  options.integrator.method = Integrator::runge_kutta_4;
  options.integrator.fixed_step = 1 / (10 * stage.mesh_frequency());
  BOOST_CHECK_THROW((void)simulate(stage, options), InputError);
  options.integrator.fixed_step /= 10;
  BOOST_TEST(simulate(stage, options).energy.relative <= 1e-4);
}

// Whatever the load, the sun's meshes carry it; branches can but push.
BOOST_AUTO_TEST_CASE(light_loads_are_balanced_to_rounding) {
  for (const double share : {1.0, 1e-3, 1e-6, 1e-9}) {
    auto stage = stages::ring_paper();
    stage.sun_torque *= share;
    const auto path = quasi_static(stage, 4, 2000);
    const double force = stage.sun_torque / stage.sun.radius;
    // Positions of 5e-5 m carry some 1e-20 m of rounding, under 1e9 N/m: 1e-11 N per mesh and spring.
    const double rounding = 1e-9 + 1e-9 / force;
    const double off = (path.sun_force.colwise().sum().array() / force - 1).abs().maxCoeff();
    BOOST_TEST(off <= rounding, "at " << share << " of the load off by " << off << ", allowed " << rounding);
    BOOST_TEST(path.sun_force.minCoeff() >= 0);
    BOOST_TEST(path.ring_force.minCoeff() >= 0);
  }
}

// Unequal planets on held centres share by their paths alone: L = 1 + max K (mean error - error) / F.
BOOST_AUTO_TEST_CASE(unequal_planet_spacing) {
  auto stage = with_supports(rigid);
  stage.planet_bearings = {{1e9, 1e9}};
  stage.ring.torsional_support = rigid;
  stage.planet_angles.clear(), stage.sun_phase_lag.clear(), stage.ring_phase_lag.clear();
  const auto fraction = [](double x) { return x - std::floor(x); };
  for (const int place : {0, 38, 84, 129, 170}) {  // of z_s + z_r = 210 places a planet fits in
    const double phi = 2 * std::numbers::pi * place / 210;
    stage.planet_angles.push_back(phi);
    stage.sun_phase_lag.push_back(fraction(48.0 * place / 210));
    stage.ring_phase_lag.push_back(fraction(-162.0 * place / 210));
  }
  stage.sun_mesh = ConstantStiffness{1.364e9};
  stage.ring_mesh = ConstantStiffness{1.87e9};
  const double as = stage.sun_working_angle, ar = stage.ring_working_angle;
  const double path = 1 / (1 / 1.364e9 + 1 / 1.87e9 +
                           (std::pow(std::cos(as) + std::cos(ar), 2) + std::pow(std::sin(as) - std::sin(ar), 2)) / 1e9);
  const auto system = assemble(stage);
  Eigen::VectorXd error = Eigen::VectorXd::Zero(5);
  for (int m = 0; m < 10; ++m)
    for (const auto& e : system.meshes()[m].errors) error[m % 5] += e.amount * std::sin(e.phase);
  const double expected = 1 + path * (error.mean() - error.minCoeff()) / stage.mean_mesh_force();
  const auto positions = quasi_static(stage, 4, 2000);
  BOOST_TEST(std::abs(5 * positions.sun_force.col(0).maxCoeff() / positions.sun_force.col(0).sum() - expected) <=
             1e-9 * expected);
  const auto response = simulate(stage);
  BOOST_TEST(response.steady);
  BOOST_TEST(response.force_balance_relative <= 1e-6);
  BOOST_TEST(response.energy.relative <= 1e-5);
}

// Predicted within a factor of five of what it takes (of the processor, beside others).
BOOST_AUTO_TEST_CASE(the_time_of_integration_is_predicted) {
  const auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const double frequency = stage.mesh_frequency();
  const double some = integration_seconds(system, frequency, 1000, {});
  BOOST_TEST(std::abs(integration_seconds(system, frequency, 1e6, {}) / some - 1000) <= 1e-6);
  SimulationOptions options;
  options.mesh_cycles = 1000;
  options.estimate_error = false;
  const auto start = std::clock();
  (void)simulate(stage, options);
  const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  BOOST_TEST_MESSAGE("1000 mesh cycles: predicted " << some << " s, taken " << taken << " s");
  BOOST_TEST(some > taken / 5);
  BOOST_TEST(some < taken * 5);
  auto slow = stage;
  slow.carrier_speed /= 100;
  IntegratorOptions explicit_method;
  explicit_method.method = Integrator::arkode_explicit;
  BOOST_TEST(integration_seconds(assemble(slow), slow.mesh_frequency(), 1, explicit_method) >
             20 * integration_seconds(system, frequency, 1, explicit_method));
  // BDF follows fast motions that hardly die out.
  auto light = stage;
  light.planet.inertia *= 1e-6;
  IntegratorOptions bdf;
  bdf.method = Integrator::cvode_bdf;
  BOOST_TEST(integration_seconds(assemble(light), frequency, 1, bdf) >
             20 * integration_seconds(system, frequency, 1, bdf));
}

BOOST_AUTO_TEST_SUITE_END()
