#include "dynamics/steady_state/steady_response.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(steady_response)

using namespace annulus;
using namespace annulus::dynamics;

constexpr double frequency = 200, mass = 2, ground = 4e6, mesh_stiffness = 3e7;

/// A mass on a spring and a mesh, b = 1 + swing sin(2 pi f t).
LumpedSystem swinging(double swing, double load) {
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("x");
  builder.add_mass(x, mass);
  builder.add_spring(x, ground, 2 * 0.1 * std::sqrt(ground * mass));
  builder.add_load(x, load);
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = x;
  mesh.excitation = ConstantStiffness{mesh_stiffness};
  mesh.frequency = frequency;
  mesh.damping = 500;
  mesh.errors = {{1e-6, 2 * std::numbers::pi * frequency, 0.3}};
  if (swing != 0) mesh.moving = {{0, {}, {swing, 2 * std::numbers::pi * frequency, 0}}};
  builder.add_mesh(mesh);
  return builder.build();
}

const SteadyProblem problem{frequency, 1, 1000, mesh_stiffness};

BOOST_AUTO_TEST_CASE(moving_mesh_vectors_are_integrated_in_time) {
  test::Verification record("Steady state with a moving mesh vector", "balance of energy");
  const auto moving = dynamics::steady_response(swinging(0.2, 1000), problem);
  BOOST_REQUIRE(moving.periodic.has_value());
  BOOST_TEST(!moving.periodic->converged);
  BOOST_TEST(!moving.periodic->trouble.empty());
  BOOST_TEST(moving.steady);
  BOOST_TEST(!moving.confirmed);
  BOOST_TEST(moving.total_cycles > moving.window_cycles);
  // Tolerance of the integrator, 1e-6, times some thousand steps.
  record.at_most("energy balance, relative", "", moving.energy.relative, 1e-4,
                 "integrator: some thousand steps of 1e-6");
  BOOST_TEST(std::abs(moving.energy.change) < 1e-3 * moving.energy.dissipated);
  // A small swing is near the solution without, and linear in it.
  const auto still = dynamics::steady_response(swinging(0, 1000), problem);
  BOOST_TEST(still.confirmed);
  const auto distance = [&](double swing) {
    const auto r = dynamics::steady_response(swinging(swing, 1000), problem);
    return (r.best.displacement - still.best.displacement).cwiseAbs().maxCoeff();
  };
  // The neglected second order is as large as the swing; both windows are steady to 1e-3 of the force alone.
  BOOST_TEST(distance(0.04) / distance(0.02) == 2.0, boost::test_tools::tolerance(0.05));
}

BOOST_AUTO_TEST_CASE(load_may_be_zero_or_reversed) {
  test::Verification record("A mass on spring and mesh, loaded forwards, backwards and not at all",
                            "superposition: the load adds its static share and nothing else");
  const auto forward = dynamics::steady_response(swinging(0, 1000), problem);
  const auto none = dynamics::steady_response(swinging(0, 0), problem);
  const auto back = dynamics::steady_response(swinging(0, -1000), problem);
  const double share = mesh_stiffness / (mesh_stiffness + ground);
  // Linear: the load adds its static part and nothing else. Harmonic balance and time integration agree to 1e-3 of the
  // scale.
  for (const auto* r : {&forward, &none, &back}) BOOST_TEST(r->confirmed);
  const double error = (forward.best.force - none.best.force).array().operator-(1000 * share).abs().maxCoeff() +
                       (back.best.force - none.best.force).array().operator+(1000 * share).abs().maxCoeff();
  record.at_most("mesh force beside the static share, largest, both directions together", "N", error, 1e-2,
                 "a hundred-thousandth of the load");
  BOOST_TEST(error < 1e-2);
}

BOOST_AUTO_TEST_CASE(windows_state_their_comparison) {
  test::Verification record("Windows of a harmonic balance and of a short time integration",
                            "counted by hand from what was asked for");
  SimulationOptions options;
  options.confirmation = Confirmation::never;
  const auto system = swinging(0, 1000);
  const auto direct = dynamics::steady_response(system, problem, options);
  record.near("mesh cycles integrated, harmonic balance", "", direct.total_cycles, 0, 0, "none");
  BOOST_REQUIRE(direct.before.has_value());
  record.near("samples over those it is compared with", "",
              static_cast<double>(direct.best.force.cols()) / static_cast<double>(direct.before->force.cols()), 2, 0,
              "half the samples");
  BOOST_TEST(!direct.loose.has_value());
  options = {};
  options.mesh_cycles = 30;  // shorter than two windows: nothing to compare with
  const auto given = dynamics::steady_response(system, problem, options);
  record.near("mesh cycles integrated, 30 asked for", "", given.total_cycles, 30, 0, "counted by hand");
  record.near("mesh cycles of the window, 30 asked for", "", given.window_cycles, 20, 0, "counted by hand");
  BOOST_TEST(!given.before.has_value());
  BOOST_TEST(given.loose.has_value());
}

constexpr double slow = 20;  // Hz

/// A mass that lifts off its mesh in every cycle.
LumpedSystem lifting() {
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = builder.add_dof("x");
  mesh.excitation = ConstantStiffness{5e4};
  mesh.frequency = slow;
  mesh.damping = 200;
  mesh.half_backlash = 5e-3;
  mesh.errors = {{8e-4, 2 * std::numbers::pi * slow, 0.3}};
  builder.add_mass(mesh.b, mass);
  builder.add_load(mesh.b, 30);
  builder.add_mesh(mesh);
  return builder.build();
}

// With loss of contact 16 samples err far more than time integration may: the harmonic balance takes more samples.
BOOST_AUTO_TEST_CASE(harmonic_balance_is_sampled_as_finely_as_its_confirmation_needs) {
  const auto system = lifting();
  const SteadyProblem lifted{slow, 1, 30, 5e4};
  SimulationOptions options;
  options.samples_per_cycle = 16;
  const auto r = dynamics::steady_response(system, lifted, options);
  BOOST_TEST(r.best.open[0] > 0.1);
  BOOST_TEST(r.confirmed);
  BOOST_TEST(r.window_cycles == 20);
  BOOST_REQUIRE(r.before.has_value());
  const auto& direct = *r.before;
  BOOST_REQUIRE(direct.force.cols() == 20 * 16);
  BOOST_REQUIRE(direct.time.size() == 20 * 16);
  BOOST_TEST(direct.time[16] == 1 / slow, boost::test_tools::tolerance(1e-12));
  // One period was solved and stands in the window twenty times.
  BOOST_TEST((direct.force.rightCols(16).array() == direct.force.leftCols(16).array()).all());
  BOOST_TEST((direct.force - r.best.force).cwiseAbs().maxCoeff() <= options.steady_tolerance * lifted.force_scale);
  // The samples asked for alone are far off, and state it.
  options.confirmation = Confirmation::never;
  options.sampling = Sampling::prescribed;
  const auto rough = dynamics::steady_response(system, lifted, options);
  BOOST_TEST((rough.best.force - r.best.force).cwiseAbs().maxCoeff() >
             20 * options.steady_tolerance * lifted.force_scale);
}

// Load sharing of 1.136 was found as 1.068 ± 0.0003 between two samples.
BOOST_AUTO_TEST_CASE(jumps_are_confirmed_by_time_integration) {
  auto stage = stages::ring_paper();
  stage.sun_mesh = RectangularStiffness{1.4e9, 0.25, 0.74};
  stage.ring_mesh = HarmonicStiffness{1.9e9, 0.06, 0.1};
  SimulationOptions options;
  options.samples_per_cycle = 32;
  options.confirmation = Confirmation::where_needed;
  options.confirm_beyond = 1;
  const auto found = simulate(stage, options);
  BOOST_TEST(found.total_cycles > 0);
  options.integrator.relative_tolerance = 1e-9;
  options.confirmation = Confirmation::always;
  options.samples_per_cycle = 64;
  const auto fine = simulate(stage, options);
  const auto a = found.sun_planet.load_sharing.instantaneous, b = fine.sun_planet.load_sharing.instantaneous;
  BOOST_TEST(std::abs(a.value - b.value) <= a.error + b.error);
  // Nothing jumps.
  stage.sun_mesh = HarmonicStiffness{1.4e9, 0.25, 0};
  options.confirmation = Confirmation::where_needed;
  BOOST_TEST(simulate(stage, options).total_cycles == 0);
}

// Slow meshes whose stiffness jumps: all meshes vibrate many times between two samples. A shaft torque of 1.014 was
// found as 1.0081 ± 0.000001.
BOOST_AUTO_TEST_CASE(vibrations_behind_jumps_are_seen_between_few_samples) {
  auto stage = stages::ring_paper();
  stage.sun_mesh = RectangularStiffness{1.4e9, 0.25, 0.74};
  stage.ring_mesh = HarmonicStiffness{1.9e9, 0.06, 0.1};
  stage.carrier_speed /= 20;
  SimulationOptions options;
  options.steady_state = SteadyState::time_integration;
  options.integrator.relative_tolerance = 1e-9;
  options.max_window_cycles = 55;
  options.samples_per_cycle = 16;
  const auto few = simulate(stage, options);
  options.samples_per_cycle = 512;
  const auto many = simulate(stage, options);
  const auto compare = [](const char* what, const Figure& a, const Figure& b) {
    BOOST_TEST_MESSAGE(what << ": " << a.value << " ± " << a.error << ", with many samples " << b.value << " ± "
                            << b.error);
    BOOST_TEST(std::abs(a.value - b.value) <= a.error + b.error, what);
    BOOST_TEST(a.error < 0.3 * a.value, what);
  };
  for (const auto& [mesh, kind] :
       {std::pair{"sun", &DynamicResponse::sun_planet}, {"ring", &DynamicResponse::ring_planet}}) {
    const auto largest_of = [k = kind](const DynamicResponse& r) {
      return largest((r.*k).branches, &BranchResult::peak_factor);
    };
    compare(mesh, largest_of(few), largest_of(many));
  }
}

// Just stable: steps of twice the length, which would show their error too, are not.
BOOST_AUTO_TEST_CASE(fixed_steps_near_their_limit_have_an_error) {
  SimulationOptions options;
  options.steady_state = SteadyState::time_integration;
  options.samples_per_cycle = 8;
  options.integrator.method = Integrator::runge_kutta_4;
  options.integrator.fixed_step = 1 / (8 * frequency);
  const auto coarse = dynamics::steady_response(swinging(0, 1000), problem, options);
  BOOST_TEST_REQUIRE(coarse.loose.has_value());
  const double stated = (coarse.loose->force - coarse.best.force).cwiseAbs().maxCoeff();
  options.integrator.fixed_step /= 100;
  const auto fine = dynamics::steady_response(swinging(0, 1000), problem, options);
  const auto cycle = [](const SteadyResponse& r) -> Eigen::MatrixXd { return r.best.force.rightCols(8); };
  const double actual = (cycle(coarse) - cycle(fine)).cwiseAbs().maxCoeff();
  BOOST_TEST(actual > 0);
  BOOST_TEST(actual < 1.5 * stated);
  BOOST_TEST(actual > 0.5 * stated);
}

BOOST_AUTO_TEST_CASE(unusable_problems_are_refused) {
  const auto system = swinging(0, 1000);
  const auto refused = [&](const SteadyProblem& p) {
    BOOST_CHECK_THROW((void)dynamics::steady_response(system, p), InputError);
  };
  refused({0, 1, 1000, 1e7});
  refused({200, 0, 1000, 1e7});
  refused({200, 1, 0, 1e7});
  refused({200, 1, 1000, std::nan("")});
}

BOOST_AUTO_TEST_SUITE_END()
