#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrate.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/tables.h"
#include "tests/verification_record.h"

/// The law of force over deflection within a system.
BOOST_AUTO_TEST_SUITE(load_dependence)

using namespace annulus::dynamics;
using tables::BentTable;

/// One mass of 2 kg behind one mesh.
LumpedSystem one_mesh(const MeshExcitation& excitation, double frequency, double force, double damping,
                      std::optional<double> half_backlash) {
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("u");
  mesh.excitation = excitation;
  mesh.frequency = frequency;
  mesh.damping = damping;
  mesh.half_backlash = half_backlash;
  builder.add_mass(mesh.b, 2);
  builder.add_load(mesh.b, force);
  builder.add_mesh(mesh);
  return builder.build();
}

PlanetaryStage stage_with_law() {
  auto stage = stages::ring_paper();
  const double load = stage.mean_mesh_force();
  const BentTable sun{.mesh = "sun_planet", .mean = 1.364e9, .ripple = 0.2, .nominal = load};
  const BentTable ring{.nominal = load, .positions = 3};
  stage.sun_mesh = table_stiffness(sun.table(), load, 0, LoadDependence::table);
  stage.ring_mesh = table_stiffness(ring.table(), load, 0, LoadDependence::table);
  return stage;
}

BOOST_AUTO_TEST_CASE(every_tabulated_load_deflects_to_its_transmission_error) {
  annulus::test::Verification record("Static deflection by a load-dependent table",
                                     "the tabulated transmission errors at all phases, positions and loads");
  const BentTable bent{.positions = 3};
  const auto table = bent.table();
  for (const std::optional<double> half : {std::optional<double>{}, std::optional<double>{40e-6}})
    for (int load = 0; load < 3; ++load) {
      const double force = table.loads()[load];
      const auto system =
          one_mesh(table_stiffness(table, bent.nominal, 0, LoadDependence::table), 100, force, 1e4, half);
      StaticSolver solver(system);
      auto workspace = system.workspace();
      for (int i = 0; i < 48; ++i) {
        const auto q = solver.solve(i / 16.0 / 100, workspace);
        const double expected = table.at(i / 16, i % 16, load).lte + half.value_or(0.0);
        // The tabulated points are passed to 1e-11 (force_surface); Newton ends at 1e-13.
        record.near("deflection over the tabulated one", "", q[0] / expected, 1, 1e-10,
                    "interpolation passes it to 1e-11");
        record.near("force over the load", "", workspace.elastic[0] / force, 1, 1e-12, "Newton ends at 1e-13");
        BOOST_TEST(system.outside_table(0, workspace) == 0);
      }
    }
}

BOOST_AUTO_TEST_CASE(loads_outside_the_table_are_reported) {
  annulus::test::Verification record("Loads outside a table of 0.25 to 1.75 times the nominal load",
                                     "the ends of the table: -1 below, 0 within, 1 above");
  const BentTable bent;
  const auto table = bent.table();
  for (const auto& [share, expected] : {std::pair{0.2, -1}, {0.3, 0}, {1.7, 0}, {1.8, 1}}) {
    const auto system =
        one_mesh(table_stiffness(table, bent.nominal, 0, LoadDependence::table), 100, share * bent.nominal, 0, 40e-6);
    StaticSolver solver(system);
    auto workspace = system.workspace();
    (void)solver.solve(0.00123, workspace);
    record.near(share < 1 ? "side of the table, 0.2 and 0.3 of the load" : "side of the table, 1.7 and 1.8 of the load",
                "", system.outside_table(0, workspace), expected, 0, "exact");
  }
  const auto system = one_mesh(ConstantStiffness{1e9}, 100, 1e9, 0, {});
  auto workspace = system.workspace();
  (void)StaticSolver(system).solve(0, workspace);
  record.near("side of the table, stiffness without a table", "", system.outside_table(0, workspace), 0, 0, "exact");
}

BOOST_AUTO_TEST_CASE(quasi_static_forces_of_a_stage_balance_and_a_linear_table_changes_nothing) {
  annulus::test::Verification record("Quasi-static forces of a stage with load-dependent meshes",
                                     "statics; a table without bend: the linear solution");
  auto stage = stage_with_law();
  const auto found = quasi_static(stage, 3);
  for (int i = 0; i < found.sun_force.cols(); ++i) {
    record.near("torque of the sun mesh forces over the load", "",
                found.sun_force.col(i).sum() * stage.sun.radius / stage.sun_torque, 1, 1e-9, "Newton's end");
    BOOST_TEST((found.sun_force.col(i) - found.ring_force.col(i)).cwiseAbs().maxCoeff() <=
               1e-9 * stage.mean_mesh_force());
  }
  // Without bend the law is the secant stiffness (at knots of the phase, where makima plays no part).
  const double load = stage.mean_mesh_force();
  const auto table = BentTable{.bend = 0, .nominal = load, .positions = 3}.table();
  stage.ring_phase_lag = stage.sun_phase_lag = {};
  stage.ring_mesh = stage.sun_mesh = table_stiffness(table, load, 0, LoadDependence::table);
  const auto law = quasi_static(stage, 4, 6);
  stage.ring_mesh = stage.sun_mesh = table_stiffness(table, load);
  const auto linear = quasi_static(stage, 4, 6);
  record.at_most("straight law against linear stiffness, over the load", "",
                 (law.sun_force - linear.sun_force).cwiseAbs().maxCoeff() / load, 1e-9, "Newton's end");
}

BOOST_AUTO_TEST_CASE(jacobian_is_the_derivative_of_the_right_hand_side) {
  annulus::test::Verification record("Jacobian with forces that follow tables",
                                     "central differences of the right-hand side");
  for (const bool backlash : {true, false}) {
    auto stage = stage_with_law();
    if (!backlash) stage.set_half_backlash({});
    const auto system = assemble(stage);
    const int n = system.dofs();
    Eigen::VectorXd y = stages::random_state(n, 2), up(2 * n), down(2 * n);
    auto workspace = system.workspace();
    const double t = 0.0123, h = 1e-9;
    system.detect_contact(t, y.data(), workspace);
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    system.jacobian(t, y.data(), jacobian, workspace);
    for (int j = 0; j < n; ++j) {  // the velocities enter linearly as before
      const double value = y[j];
      y[j] = value + h;
      system.rhs(t, y.data(), up.data(), workspace);
      y[j] = value - h;
      system.rhs(t, y.data(), down.data(), workspace);
      y[j] = value;
      const Eigen::VectorXd column = (up - down) / (2 * h);
      // Rounding: eps x 1e-4 m / 1e-9 m of the entry; curvature (h/cell)^2 with cells of 2e-6 m.
      const double bound = 1e-8 * jacobian.topRightCorner(n, n).col(j).cwiseAbs().maxCoeff() +
                           1e-7 * jacobian.col(j).cwiseAbs().maxCoeff();
      record.at_most("difference of a column over 1e-8 of its damping and 1e-7 of its stiffness", "",
                     (column - jacobian.col(j)).cwiseAbs().maxCoeff() / bound, 1, "rounding and curvature");
    }
  }
}

BOOST_AUTO_TEST_CASE(tangent_matrix_is_the_derivative_of_the_forces) {
  annulus::test::Verification record("Tangent matrix of forces that follow tables",
                                     "central differences of the forces");
  const auto system = assemble(stage_with_law());
  const int meshes = static_cast<int>(system.meshes().size());
  auto workspace = system.workspace();
  Eigen::VectorXd approach = Eigen::VectorXd::LinSpaced(meshes, -1e-4, 1.5e-4);
  const Eigen::VectorXd rate = Eigen::VectorXd::Zero(meshes);
  system.evaluate_forces(0.004, approach.data(), rate.data(), workspace);
  Eigen::MatrixXd tangent(meshes, meshes);
  system.tangent_matrix(workspace, tangent);
  const double h = 1e-9;
  for (int j = 0; j < meshes; ++j) {
    const double value = approach[j];
    approach[j] = value + h;
    system.evaluate_forces(0.004, approach.data(), rate.data(), workspace);
    Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(workspace.elastic.data(), meshes);
    approach[j] = value - h;
    system.evaluate_forces(0.004, approach.data(), rate.data(), workspace);
    column = (column - Eigen::Map<const Eigen::VectorXd>(workspace.elastic.data(), meshes)) / (2 * h);
    approach[j] = value;
    record.at_most("difference of a column over the mean stiffness", "",
                   (column - tangent.col(j)).cwiseAbs().maxCoeff() / 1.87e9, 1e-6, "rounding and curvature");
  }
}

BOOST_AUTO_TEST_CASE(power_is_the_rate_of_energy) {
  annulus::test::Verification record("Power of a stage with load-dependent meshes",
                                     "first law: rate of the energy by central differences");
  const auto system = assemble(stage_with_law());
  const int n = system.dofs();
  const Eigen::VectorXd y = stages::random_state(n, 6);
  Eigen::VectorXd dy(2 * n);
  auto workspace = system.workspace();
  const double t = 0.0321, h = 1e-8;
  system.detect_contact(t, y.data(), workspace);
  system.rhs(t, y.data(), dy.data(), workspace);
  const auto power = system.power(t, y.data(), workspace);
  const Eigen::VectorXd after = y + h * dy, before = y - h * dy;
  const double rate =
      (system.energy(t + h, after.data(), workspace) - system.energy(t - h, before.data(), workspace)) / (2 * h);
  const double scale = std::abs(power.supplied) + power.dissipated;
  record.near("rate of the energy", "W", rate, power.supplied - power.dissipated, 1e-6 * scale,
              "rounding and curvature over a step of 10 ns");
}

BOOST_AUTO_TEST_CASE(an_undamped_constant_law_conserves_energy) {
  annulus::test::Verification record("A mass rattling on a bent law of force", "conservation of energy");
  const BentTable bent{.ripple = 0};
  auto table = bent.table();
  auto excitation = table_stiffness(table, bent.nominal, 0, LoadDependence::table);
  excitation.unloaded_te = annulus::PeriodicCurve({0.0}, 1);  // else it would drive
  const auto system = one_mesh(excitation, 100, 0, 0, 20e-6);
  auto workspace = system.workspace();
  SystemState state;
  state.q = Eigen::VectorXd::Constant(1, 60e-6);
  state.v = Eigen::VectorXd::Zero(1);
  Eigen::VectorXd y(2);
  y << state.q, state.v;
  system.detect_contact(0, y.data(), workspace);
  const double before = system.energy(0, y.data(), workspace);
  BOOST_TEST(before > 0.1 * 0.5 * 1.87e9 * 40e-6 * 40e-6);
  IntegratorOptions options;
  options.relative_tolerance = 1e-10;
  options.absolute_tolerance = 1e-15;
  const auto statistics = integrate(system, state, 0.02, options, workspace);
  BOOST_TEST(statistics.contact_events > 50);  // it rattles between both flanks
  y << state.q, state.v;
  system.detect_contact(state.time, y.data(), workspace);
  const double after = system.energy(state.time, y.data(), workspace);
  // Some thousand steps with relative errors of 1e-10, twice that in the energy.
  record.near("energy", "J", after, before, 2e-10 * static_cast<double>(statistics.steps) * before,
              "2 x steps x tolerance of the integrator");
}

BOOST_AUTO_TEST_CASE(energy_changes_by_what_is_supplied_and_dissipated) {
  annulus::test::Verification record("Energy of a stage with load-dependent meshes",
                                     "first law: change of energy = supplied work - dissipated work");
  const auto system = assemble(stage_with_law());
  const int n = system.dofs();
  auto workspace = system.workspace();
  SystemState state;
  state.q = StaticSolver(system).solve(0, workspace);
  state.v = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd y(2 * n);
  y << state.q, state.v;
  const double before = system.energy(0, y.data(), workspace);
  IntegratorOptions options;
  options.relative_tolerance = 1e-10;
  integrate(system, state, 0.01, options, workspace, {.energy = EnergyTracking::on});
  y << state.q, state.v;
  const double after = system.energy(state.time, y.data(), workspace);
  BOOST_TEST(state.dissipated > 0);
  const double moved = std::abs(state.supplied) + state.dissipated + before;
  // The energies are integrated beside the state without steering the step.
  record.near("change of energy", "J", after - before, state.supplied - state.dissipated, 1e-6 * moved,
              "energies are integrated beside the state without steering the step");
}

BOOST_AUTO_TEST_CASE(small_vibrations_about_the_nominal_load_have_the_tangent_frequency) {
  annulus::test::Verification record("Small vibration about the nominal load on a bent law",
                                     "closed form: sqrt(tangent stiffness / mass); ten periods");
  const BentTable bent{.ripple = 0};
  auto excitation = table_stiffness(bent.table(), bent.nominal, 0, LoadDependence::table);
  excitation.unloaded_te = annulus::PeriodicCurve({0.0}, 1);
  const auto system = one_mesh(excitation, 0, bent.nominal, 0, {});
  auto workspace = system.workspace();
  SystemState state;
  state.q = StaticSolver(system).solve(0, workspace);
  const double rest = state.q[0], amplitude = 1e-4 * rest;
  state.q[0] += amplitude;
  state.v = Eigen::VectorXd::Zero(1);
  const double w = std::sqrt(bent.nominal / bent.deflection(0, bent.nominal) / 0.9 / 2);
  IntegratorOptions options;
  options.relative_tolerance = 1e-12;
  options.absolute_tolerance = 1e-10 * amplitude;
  integrate(system, state, 20 * std::numbers::pi / w, options, workspace);  // ten periods
  // The frequency shift by the curvature of the law is of second order in the amplitude, 1e-8.
  const char* origin = "curvature of the law: second order in the amplitude";
  record.near("displacement over amplitude", "", (state.q[0] - rest) / amplitude, 1, 1e-4, origin);
  record.near("velocity over amplitude", "", state.v[0] / (w * amplitude), 0, 1e-3, origin);
}

BOOST_AUTO_TEST_SUITE_END()
