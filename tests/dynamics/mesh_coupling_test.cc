#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrate.h"
#include "tests/dynamics/allocation_counter.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/tables.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(mesh_coupling)

using namespace annulus;
using namespace annulus::dynamics;
using Contact = LumpedSystem::Contact;

constexpr double tau = 2 * std::numbers::pi;

/// Two masses, each behind a mesh of its own; the meshes coupled by `compliance`.
LumpedSystem pair_of_meshes(const Eigen::Matrix2d& compliance, std::optional<double> half_backlash,
                            Eigen::Vector2d load = {0, 0}) {
  LumpedSystemBuilder builder;
  for (int i = 0; i < 2; ++i) {
    MeshElement mesh;
    mesh.name = "m" + std::to_string(i);
    mesh.b = builder.add_dof("u" + std::to_string(i));
    mesh.excitation = ConstantStiffness{(i + 1) * 1e9};
    mesh.half_backlash = half_backlash;
    mesh.damping = 100;
    builder.add_mass(mesh.b, 1 + i);
    builder.add_load(mesh.b, load[i]);
    builder.add_mesh(mesh);
  }
  builder.add_mesh_coupling({{0, 1}, compliance_curves({compliance}, 1), {}});
  return builder.build();
}

/// A coupling of the ring paper's size: D some tenths of the mesh compliance, changing over three ring positions.
std::shared_ptr<RingCoupling> coupling(double scale, int modes, int planets = 5, int teeth = 162) {
  auto c = std::make_shared<RingCoupling>();
  c->planets = planets;
  c->ring_teeth = teeth;
  c->per_cycle = 4;
  for (int i = 0; i < 12; ++i) {
    Eigen::MatrixXd d(planets, planets);
    for (int n = 0; n < planets; ++n)
      for (int m = 0; m <= n; ++m)
        d(n, m) = d(m, n) =
            n == m ? 0 : scale * (std::cos(tau * 2 * (n - m) / planets) + 0.3 * std::cos(tau * (i / 12.0 + n + m)));
    c->compliance.push_back(d);
  }
  for (int k = 0; k < modes; ++k) {
    RingMode mode;
    mode.frequency = 1500 + 800 * k;
    mode.waves = 2 + k / 2;
    for (int tooth = 0; tooth < teeth; ++tooth)
      mode.deflection.push_back(0.05 * std::cos(tau * mode.waves * tooth / teeth - tau / 4 * (k % 2)));
    mode.translation_x = 0.4;
    mode.translation_y = k % 2 ? -0.3 : 0.3;
    mode.rotation = 0.2;
    c->modes.push_back(mode);
  }
  return c;
}

PlanetaryStage stage_with(std::shared_ptr<const RingCoupling> ring_coupling,
                          LoadDependence ring = LoadDependence::table) {
  auto stage = stages::ring_paper();
  const double load = stage.mean_mesh_force();
  if (ring == LoadDependence::table)
    stage.ring_mesh =
        table_stiffness(tables::BentTable{.nominal = load, .positions = 3}.table(), load, 0, LoadDependence::table);
  stage.ring_coupling = std::move(ring_coupling);
  return stage;
}

BOOST_AUTO_TEST_CASE(two_meshes_by_hand) {
  annulus::test::Verification record("Forces of two coupled meshes", "two equations solved by hand");
  const double k1 = 1e9, k2 = 2e9, d12 = 2e-10, half = 10e-6;
  const Eigen::Matrix2d d = (Eigen::Matrix2d() << 0, d12, d12, 0).finished();
  auto system = pair_of_meshes(d, {});
  auto w = system.workspace();
  const Eigen::Vector2d approach(30e-6, 20e-6), rate(0.1, 0.2);
  system.evaluate_forces(0, approach.data(), rate.data(), w);
  // F1/k1 + d F2 = x1, F2/k2 + d F1 = x2
  const double determinant = 1 / (k1 * k2) - d12 * d12;
  const double f1 = (approach[0] / k2 - d12 * approach[1]) / determinant;
  const double f2 = (approach[1] / k1 - d12 * approach[0]) / determinant;
  record.near("first force over the solution", "", w.elastic[0] / f1, 1, 1e-12, "rounding");
  record.near("second force over the solution", "", w.elastic[1] / f2, 1, 1e-12, "rounding");
  BOOST_TEST(std::abs(w.delta[0] / (f1 / k1) - 1) <= 1e-12);  // what the mesh's own law meets
  BOOST_TEST(std::abs(w.force[0] - w.elastic[0] - 100 * 0.1) <= 1e-9);
  Eigen::MatrixXd tangent(2, 2);
  system.tangent_matrix(w, tangent);
  const Eigen::Matrix2d expected = (Eigen::Matrix2d() << 1 / k2, -d12, -d12, 1 / k1).finished() / determinant;
  record.at_most("tangent stiffness, largest error", "N/m", (tangent - expected).cwiseAbs().maxCoeff(), 1e-12 * 2e9,
                 "rounding");

  // With backlash the first mesh presses so hard that the ring leaves the second one: 1e9 x 90 um = 90 kN, which takes
  // 18 um from the 25 um of the second.
  system = pair_of_meshes(d, half);
  w = system.workspace();
  const Eigen::Vector2d uneven(100e-6, 25e-6);
  system.evaluate_forces(0, uneven.data(), rate.data(), w);
  BOOST_TEST((w.contact[0] == Contact::drive));
  BOOST_TEST((w.contact[1] == Contact::open));
  BOOST_TEST(std::abs(w.elastic[0] / (k1 * 90e-6) - 1) <= 1e-12);
  BOOST_TEST(w.elastic[1] == 0.0);
  BOOST_TEST(w.force[1] == 0.0);
  BOOST_TEST(std::abs(w.delta[1] - (25e-6 - d12 * k1 * 90e-6)) <= 1e-18);
  system.tangent_matrix(w, tangent);
  BOOST_TEST(std::abs(tangent(0, 0) / k1 - 1) <= 1e-12);
  BOOST_TEST(tangent.row(1).cwiseAbs().maxCoeff() + tangent.col(1).cwiseAbs().maxCoeff() == 0.0);

  // A held state is kept: the second mesh held closed pulls.
  w.contact[1] = Contact::drive;
  const Eigen::Vector2d rest(0, 0);
  system.evaluate_meshes(0, uneven.data(), rest.data(), w);
  BOOST_TEST(w.elastic[1] < 0);
  BOOST_TEST(std::abs(w.elastic[1] - k2 * (w.delta[1] - half)) <= 1e-12 * k1 * 90e-6);
}

BOOST_AUTO_TEST_CASE(a_coupling_is_an_elastic_network_without_mass) {
  // Springs a, b from two ring nodes to ground and c between them: S = [a + c, -c; -c, b + c], D = S^-1.
  const double a = 3e9, b = 4e9, c = 2e9;
  const Eigen::Matrix2d stiffness = (Eigen::Matrix2d() << a + c, -c, -c, b + c).finished();
  const Eigen::Vector2d load(4e4, 7e4);
  const auto coupled = pair_of_meshes(stiffness.inverse(), {}, load);
  auto w = coupled.workspace();
  const auto q = StaticSolver(coupled).solve(0, w);

  LumpedSystemBuilder builder;
  LinearForm node[2], body[2];
  for (int i = 0; i < 2; ++i) {
    body[i] = builder.add_dof("u" + std::to_string(i));
    node[i] = builder.add_dof("node" + std::to_string(i));
    builder.add_mass(body[i], 1);
    builder.add_mass(node[i], 1);
    builder.add_load(body[i], load[i]);
    MeshElement mesh;
    mesh.name = "m" + std::to_string(i);
    mesh.b = body[i] + (-1.0) * node[i];
    mesh.excitation = ConstantStiffness{(i + 1) * 1e9};
    builder.add_mesh(mesh);
  }
  builder.add_spring(node[0], a, 0);
  builder.add_spring(node[1], b, 0);
  builder.add_spring(node[0] + (-1.0) * node[1], c, 0);
  const auto network = builder.build();
  auto network_workspace = network.workspace();
  const auto all = StaticSolver(network).solve(0, network_workspace);
  annulus::test::Verification record("Two meshes coupled through the compliance of the ring",
                                     "a network of springs without mass; closed form q = F/k + D F");
  record.close("first displacement, network", "m", q[0], all[0], 1e-11, "rounding of the solve");
  record.close("second displacement, network", "m", q[1], all[2], 1e-11, "rounding of the solve");
  // and in closed form: F = load, q = F/k + D F
  const Eigen::Vector2d given = stiffness.inverse() * load;
  record.close("first displacement, closed form", "m", q[0], load[0] / 1e9 + given[0], 1e-11, "rounding of the solve");
  record.close("second displacement, closed form", "m", q[1], load[1] / 2e9 + given[1], 1e-11, "rounding of the solve");
  // The elastic energy of the coupling is that of the network.
  Eigen::VectorXd y(4), z(8);
  y << q, 0, 0;
  z << all, 0, 0, 0, 0;
  record.close("elastic energy", "J", coupled.energy(0, y.data(), w), network.energy(0, z.data(), network_workspace),
               1e-11, "rounding of the solve");
}

BOOST_AUTO_TEST_CASE(without_compliance_nothing_changes) {
  annulus::test::Verification record("A stage coupled through a ring without compliance", "the stage without coupling");
  const auto coupled = assemble(stage_with(coupling(0, 0))), alone = assemble(stage_with(nullptr));
  const int n = alone.dofs();
  BOOST_REQUIRE(coupled.dofs() == n);
  auto w = coupled.workspace(), v = alone.workspace();
  const auto y = stages::random_state(n, 1);
  Eigen::VectorXd a(2 * n), b(2 * n);
  Eigen::MatrixXd j(2 * n, 2 * n), k(2 * n, 2 * n);
  for (int i = 0; i < 20; ++i) {
    const double t = i * 3.3e-4;
    coupled.detect_contact(t, y.data(), w);
    alone.detect_contact(t, y.data(), v);
    BOOST_TEST((w.contact == v.contact));
    coupled.rhs(t, y.data(), a.data(), w);
    alone.rhs(t, y.data(), b.data(), v);
    record.at_most("right-hand side, largest difference", "", (a - b).cwiseAbs().maxCoeff(), 0, "the same operations");
    coupled.jacobian(t, y.data(), j, w);
    alone.jacobian(t, y.data(), k, v);
    record.at_most("Jacobian, largest difference over its largest entry", "",
                   (j - k).cwiseAbs().maxCoeff() / k.cwiseAbs().maxCoeff(), 1e-14, "rounding");
    record.near("energy", "J", coupled.energy(t, y.data(), w), alone.energy(t, y.data(), v), 0, "the same operations");
  }
}

BOOST_AUTO_TEST_CASE(forces_solve_their_equations_in_every_contact_state) {
  annulus::test::Verification record("Coupled meshes with backlash in any state of contact",
                                     "every mesh's own law at its own deflection");
  const auto stage = stage_with(coupling(1e-10, 0));
  const auto system = assemble(stage);
  auto w = system.workspace();
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-2e-4, 2.5e-4);
  const Eigen::VectorXd rate = Eigen::VectorXd::Zero(10);
  const auto curves = compliance_curves(stage.ring_coupling->compliance, 4);
  int open = 0, closed = 0;
  for (int i = 0; i < 200; ++i) {
    const double t = i * 1.7e-4;
    Eigen::VectorXd approach(10);
    for (int m = 0; m < 10; ++m) approach[m] = uniform(engine);
    system.evaluate_forces(t, approach.data(), rate.data(), w);
    int k = 0;
    Eigen::MatrixXd d(5, 5);
    for (int n = 0; n < 5; ++n)
      for (int m = 0; m <= n; ++m, ++k) d(n, m) = d(m, n) = curves[k](stage.mesh_frequency() * t);
    const Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(w.elastic.data() + 5, 5);
    const auto& surface = *std::get<TableStiffness>(stage.ring_mesh).surface;
    for (int n = 0; n < 5; ++n) {
      const double own = approach[5 + n] - w.error[5 + n] - d.row(n).dot(force);
      const double half = 50e-6, g = own > half ? own - half : own < -half ? own + half : 0;
      const double phase = stage.mesh_frequency() * t - stage.ring_phase_lag[n];
      record.near("force over the largest force", "", force[n] / force.cwiseAbs().maxCoeff(),
                  surface(phase, g).force / force.cwiseAbs().maxCoeff(), 1e-11, "Newton's end");
      (g == 0 ? open : closed) += 1;
    }
  }
  BOOST_TEST(open > 50);
  BOOST_TEST(closed > 500);
}

BOOST_AUTO_TEST_CASE(jacobian_and_tangent_matrix_are_derivatives) {
  annulus::test::Verification record("Jacobian and tangent matrix of meshes coupled through the ring",
                                     "central differences of right-hand side and forces");
  for (const int modes : {0, 3}) {
    auto stage = stage_with(coupling(1e-10, modes));
    stage.carrier_speed = 300;  // the carrier turns so fast past the ring that moving vectors matter
    const auto system = assemble(stage);
    const int n = system.dofs();
    BOOST_TEST(system.has_moving_vectors() == (modes > 0));
    Eigen::VectorXd y = stages::random_state(n, 2), up(2 * n), down(2 * n);
    auto w = system.workspace();
    const double t = 0.0123;
    system.detect_contact(t, y.data(), w);
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    system.jacobian(t, y.data(), jacobian, w);
    for (int j = 0; j < 2 * n; ++j) {
      const double value = y[j], h = j < n ? 1e-9 : 1e-3;
      y[j] = value + h;
      system.rhs(t, y.data(), up.data(), w);
      y[j] = value - h;
      system.rhs(t, y.data(), down.data(), w);
      y[j] = value;
      const Eigen::VectorXd column = (up - down) / (2 * h);
      // 1e-9 m: forces of 1e5 N solved to 1e-13, over 1e9 N/m x 1e-9 m; curvature of the law (h/cell)^2.
      const double difference = (column - jacobian.col(j)).cwiseAbs().maxCoeff();
      record.at_most("difference of a column of the Jacobian over its largest entry", "",
                     difference / jacobian.middleCols(j < n ? 0 : n, n).cwiseAbs().maxCoeff(), 1e-6,
                     "rounding and curvature");
      record.at_most("difference of a column of the Jacobian over its own largest entry", "",
                     difference / (1 + jacobian.col(j).cwiseAbs().maxCoeff()), 1e-4, "rounding and curvature");
    }
    Eigen::VectorXd approach = Eigen::VectorXd::LinSpaced(10, -1e-4, 1.5e-4);
    const Eigen::VectorXd rate = Eigen::VectorXd::Zero(10);
    Eigen::MatrixXd tangent(10, 10);
    system.evaluate_forces(t, approach.data(), rate.data(), w);
    system.tangent_matrix(w, tangent);
    BOOST_TEST((tangent - tangent.transpose()).cwiseAbs().maxCoeff() == 0.0);
    const double h = 1e-9;
    for (int j = 0; j < 10; ++j) {
      const double value = approach[j];
      approach[j] = value + h;
      system.evaluate_forces(t, approach.data(), rate.data(), w);
      Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(w.elastic.data(), 10);
      approach[j] = value - h;
      system.evaluate_forces(t, approach.data(), rate.data(), w);
      column = (column - Eigen::Map<const Eigen::VectorXd>(w.elastic.data(), 10)) / (2 * h);
      approach[j] = value;
      record.at_most("difference of a column of the tangent over the mean stiffness", "",
                     (column - tangent.col(j)).cwiseAbs().maxCoeff() / 1.87e9, 1e-5, "rounding and curvature");
    }
  }
}

BOOST_AUTO_TEST_CASE(right_hand_side_with_moving_vectors_is_the_matrix_equation) {
  annulus::test::Verification record("Right-hand side with elastic modes of the ring",
                                     "the matrix equation with the vectors of its instant");
  const auto system = assemble(stage_with(coupling(1e-10, 3)));
  const int n = system.dofs();
  const auto y = stages::random_state(n, 4);
  Eigen::VectorXd dy(2 * n);
  auto w = system.workspace();
  const double t = 0.02, h = 1e-7;
  system.detect_contact(t, y.data(), w);
  system.rhs(t, y.data(), dy.data(), w);
  Eigen::VectorXd force = system.load() - (system.damping() + system.gyroscopic()) * y.tail(n) -
                          (system.stiffness() + system.rotating_stiffness()) * y.head(n);
  const auto approach_at = [&](double time, const Eigen::VectorXd& q, int m) {
    auto other = system.workspace();
    system.evaluate_excitation(time, other);
    return system.mesh_vector(m, time).dot(q) - other.error[m];
  };
  for (int m = 0; m < 10; ++m) {
    const auto b = system.mesh_vector(m, t);
    force -= b * w.force[m];
    record.at_most("approach, difference", "m", std::abs(w.approach[m] - approach_at(t, y.head(n), m)), 1e-17,
                   "rounding");
    const double rate =
        (approach_at(t + h, y.head(n) + h * y.tail(n), m) - approach_at(t - h, y.head(n) - h * y.tail(n), m)) / (2 * h);
    // eps x 1e-4 m / 1e-7 s, and the curvature of the errors (55 cycles): far below 1e-8 m/s of 0.1 m/s.
    record.at_most("rate of approach against central differences", "m/s", std::abs(w.delta_rate[m] - rate), 1e-8,
                   "rounding over the step");
  }
  const Eigen::VectorXd residual = system.mass() * dy.tail(n) - force;
  record.at_most("residual over the largest force and the degrees of freedom", "",
                 residual.cwiseAbs().maxCoeff() / force.cwiseAbs().maxCoeff() / n, 1e-12, "rounding");
}

BOOST_AUTO_TEST_CASE(power_is_the_rate_of_energy) {
  annulus::test::Verification record("Power of a stage whose meshes are coupled through the ring",
                                     "first law: rate of the energy by central differences");
  for (const int modes : {0, 3}) {
    const auto system = assemble(stage_with(coupling(1e-10, modes)));
    const int n = system.dofs();
    const auto y = stages::random_state(n, 6);
    Eigen::VectorXd dy(2 * n);
    auto w = system.workspace();
    const double t = 0.0321, h = 1e-8;
    system.detect_contact(t, y.data(), w);
    system.rhs(t, y.data(), dy.data(), w);
    const auto power = system.power(t, y.data(), w);
    const Eigen::VectorXd after = y + h * dy, before = y - h * dy;
    const double rate = (system.energy(t + h, after.data(), w) - system.energy(t - h, before.data(), w)) / (2 * h);
    const double scale = std::abs(power.supplied) + power.dissipated;
    record.near("rate of the energy", "W", rate, power.supplied - power.dissipated, 1e-6 * scale,
                "rounding and curvature over a step of 10 ns");
  }
}

BOOST_AUTO_TEST_CASE(energy_changes_by_what_is_supplied_and_dissipated) {
  annulus::test::Verification record("Energy of a stage whose meshes are coupled through the ring",
                                     "first law: change of energy = supplied work - dissipated work");
  for (const int modes : {0, 3}) {
    const auto system = assemble(stage_with(coupling(1e-10, modes)));
    const int n = system.dofs();
    auto w = system.workspace();
    SystemState state;
    state.q = StaticSolver(system).solve(0, w);
    state.v = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd y(2 * n);
    y << state.q, state.v;
    const double before = system.energy(0, y.data(), w);
    IntegratorOptions options;
    options.relative_tolerance = 1e-10;
    integrate(system, state, 0.01, options, w, {.energy = EnergyTracking::on});
    y << state.q, state.v;
    const double after = system.energy(state.time, y.data(), w);
    const double moved = std::abs(state.supplied) + state.dissipated + before;
    record.near(modes > 0 ? "change of energy, elastic modes of the ring" : "change of energy, static coupling", "J",
                after - before, state.supplied - state.dissipated, 1e-6 * moved,
                "energies are integrated beside the state without steering the step");
  }
}

BOOST_AUTO_TEST_CASE(modes_kept_change_nothing_statically) {
  annulus::test::Verification record("Elastic modes of the ring in statics",
                                     "theorem: what the modes give way is part of the static compliance");
  auto with = coupling(1e-10, 3), without = std::make_shared<RingCoupling>(*with);
  without->modes.clear();
  // What the modes give way is part of D: without any the single mesh and D hold all of it.
  const auto forces = quasi_static(stage_with(without), 3, 27), kept = quasi_static(stage_with(with), 3, 27);
  const double load = stages::ring_paper().mean_mesh_force();
  record.at_most("ring mesh forces with and without modes, difference over the load", "",
                 (forces.ring_force - kept.ring_force).cwiseAbs().maxCoeff() / load, 1e-9, "rounding of the solve");
  record.at_most("sun mesh forces with and without modes, difference over the load", "",
                 (forces.sun_force - kept.sun_force).cwiseAbs().maxCoeff() / load, 1e-9, "rounding of the solve");
  // and the coupling is not negligible
  const auto alone = quasi_static(stage_with(nullptr), 3, 27);
  BOOST_TEST((forces.ring_force - alone.ring_force).cwiseAbs().maxCoeff() >= 1e-3 * load);
}

BOOST_AUTO_TEST_CASE(a_ring_in_the_housing_moves_as_in_the_carrier_frame) {
  annulus::test::Verification record("A ring described in the housing",
                                     "the same stage described in the carrier frame");
  // A mode that closes nothing and is not coupled only moves the ring's coordinates to the housing.
  auto inert = coupling(1e-10, 1);
  inert->modes[0].deflection.assign(162, 0.0);
  inert->modes[0].translation_x = inert->modes[0].translation_y = inert->modes[0].rotation = 0;
  auto none = std::make_shared<RingCoupling>(*inert);
  none->modes.clear();
  double force[2][10];
  for (const bool housing : {false, true}) {
    auto stage = stage_with(housing ? inert : none);
    stage.carrier_speed = 200;  // gyroscopic, centripetal and damper terms of the turning frame count
    const auto system = assemble(stage);
    auto w = system.workspace();
    SystemState state;
    state.q = StaticSolver(system).solve(0, w);
    state.v = Eigen::VectorXd::Zero(system.dofs());
    // At rest in the turning frame at time 0: in the housing the ring then moves with Omega x r.
    const int x = system.find("ring_x"), y = system.find("ring_y");
    if (housing) {
      state.v[x] = -200 * state.q[y];
      state.v[y] = 200 * state.q[x];
    }
    IntegratorOptions options;
    options.relative_tolerance = 1e-10;
    integrate(system, state, 0.004, options, w);
    system.evaluate_meshes(state.time, state.q.data(), state.v.data(), w);
    std::copy_n(w.force.data(), 10, force[housing]);
  }
  for (int m = 0; m < 10; ++m)
    record.near("mesh force after 4 ms", "N", force[1][m], force[0][m], 1e-6 * 59e3, "global error of 1e-10 per step");
}

BOOST_AUTO_TEST_CASE(natural_frequencies_of_a_ring_mode) {
  annulus::test::Verification record("An elastic mode of the ring coupled by inertia to its translation",
                                     "closed form: quadratic for two frequencies");
  auto stage = stage_with(coupling(0, 1), LoadDependence::nominal);
  const auto system = assemble(stage);
  const int mode = system.find("ring_mode1"), x = system.find("ring_x");
  BOOST_REQUIRE(mode == system.dofs() - 1);
  BOOST_TEST(system.damping()(mode, mode) == 2 * 0.03 * tau * 1500, boost::test_tools::tolerance(1e-14));
  // Meshes off, the mode coupled by inertia to ring_x alone: (m - t^2) l^2 - (k + w^2 m) l + k w^2 = 0, l = omega^2.
  auto alone = std::make_shared<RingCoupling>(*stage.ring_coupling);
  alone->modes[0].translation_y = alone->modes[0].rotation = 0;
  stage.ring_coupling = alone;
  const auto coupled = assemble(stage);
  BOOST_TEST(coupled.mass()(x, mode) == 0.4);
  const auto found = modes(coupled, Eigen::VectorXd::Zero(10));
  const double m = 31.25, k = 1e9, w2 = std::pow(tau * 1500, 2), t = 0.4;
  const double a = m - t * t, b = k + w2 * m, root = std::sqrt(b * b - 4 * a * k * w2);
  for (const double square : {(b - root) / (2 * a), (b + root) / (2 * a)}) {
    double nearest = 1e99;
    for (const auto& f : found.modes)
      nearest = std::min(nearest, std::abs(f.frequency / (std::sqrt(square) / tau) - 1));
    record.at_most("relative difference of a frequency", "", nearest, 1e-9, "rounding of the eigenvalue solver");
  }
}

BOOST_AUTO_TEST_CASE(the_right_hand_side_does_not_allocate) {
  annulus::test::Verification record("Memory taken by the right-hand side of a coupled stage",
                                     "every operator new of the program, counted");
  const auto system = assemble(stage_with(coupling(1e-10, 3)));
  const int n = system.dofs();
  const auto y = stages::random_state(n, 8);
  Eigen::VectorXd dy(2 * n);
  auto w = system.workspace();
  const long before = allocations();
  for (int i = 0; i < 10; ++i) {
    system.detect_contact(i * 1e-4, y.data(), w);
    system.rhs(i * 1e-4, y.data(), dy.data(), w);
    (void)system.power(i * 1e-4, y.data(), w);
  }
  const long after = allocations();
  record.at_most("allocations in ten evaluations", "", static_cast<double>(after - before), 0, "none");
}

BOOST_AUTO_TEST_CASE(the_period_holds_the_coupling) {
  auto stage = stage_with(coupling(1e-10, 0), LoadDependence::nominal);
  stage.planet_errors.clear();
  annulus::test::Verification record("Period of a stage whose meshes are coupled through the ring",
                                     "counted by hand: three ring positions; with a mode all 162 teeth");
  record.near("period, static coupling", "mesh cycles", stage.error_period(), 3, 0, "exact");
  stage.ring_coupling = coupling(1e-10, 1);
  record.near("period, elastic mode", "mesh cycles", stage.error_period(), 162, 0, "exact");
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  const auto refused = [](auto change) {
    auto c = coupling(1e-10, 1);
    change(*c);
    BOOST_CHECK_THROW((void)assemble(stage_with(c)), InputError);
  };
  refused([](auto& c) { c.planets = 4; });
  refused([](auto& c) { c.ring_teeth = 161; });
  refused([](auto& c) { c.compliance.pop_back(); });
  refused([](auto& c) { c.compliance[1](0, 1) *= 2; });
  refused([](auto& c) { c.compliance[1](0, 1) = NAN; });
  refused([](auto& c) { c.modes[0].deflection.pop_back(); });
  refused([](auto& c) { c.modes[0].frequency = 0; });
  refused([](auto& c) { c.modes[0].rotation = 1e6; });  // more than the whole ring: no positive mass matrix
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.b = builder.add_dof("u");
  mesh.excitation = ConstantStiffness{1e9};
  builder.add_mass(mesh.b, 1);
  builder.add_mesh(mesh);
  auto twice = builder;
  twice.add_mesh_coupling({{0, 0}, compliance_curves({Eigen::MatrixXd::Zero(2, 2)}, 1), {}});
  BOOST_CHECK_THROW((void)twice.build(), InputError);
  auto missing = builder;
  missing.add_mesh_coupling({{1}, compliance_curves({Eigen::MatrixXd::Zero(1, 1)}, 1), {}});
  BOOST_CHECK_THROW((void)missing.build(), InputError);
  builder.add_mesh_coupling({{0}, {}, {}});
  BOOST_CHECK_THROW((void)builder.build(), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
