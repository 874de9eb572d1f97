#include "dynamics/system/lumped_system.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "core/errors.h"
#include "tests/dynamics/allocation_counter.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/tables.h"

BOOST_AUTO_TEST_SUITE(lumped_system)

using namespace annulus::dynamics;

Eigen::VectorXd random_vector(int n, double scale, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Eigen::VectorXd v(n);
  for (int i = 0; i < n; ++i) v[i] = uniform(engine);
  return v;
}

PlanetaryStage fast_stage() {
  auto stage = stages::ring_paper();
  stage.carrier_speed = 300;  // so fast that the terms of the rotating frame are not lost beside the stiffness
  return stage;
}

BOOST_AUTO_TEST_CASE(linear_forms_add_and_scale) {
  const LinearForm a{{0, 1.0}, {2, 3.0}}, b{{2, 1.0}, {1, 5.0}};
  const LinearForm sum = a + (-2.0) * b;
  BOOST_TEST((sum == LinearForm{{0, 1.0}, {2, 1.0}, {1, -10.0}}));
}

BOOST_AUTO_TEST_CASE(matrices_have_their_symmetry) {
  const auto system = assemble(fast_stage());
  // Equal terms are added in equal order, so symmetry is exact.
  BOOST_TEST((system.mass() - system.mass().transpose()).cwiseAbs().maxCoeff() == 0.0);
  BOOST_TEST((system.stiffness() - system.stiffness().transpose()).cwiseAbs().maxCoeff() == 0.0);
  BOOST_TEST((system.damping() - system.damping().transpose()).cwiseAbs().maxCoeff() == 0.0);
  BOOST_TEST((system.gyroscopic() + system.gyroscopic().transpose()).cwiseAbs().maxCoeff() == 0.0);
  BOOST_TEST(system.gyroscopic().cwiseAbs().maxCoeff() > 0.0);
}

BOOST_AUTO_TEST_CASE(gyroscopic_forces_do_no_work) {
  const auto system = assemble(fast_stage());
  const auto v = random_vector(system.dofs(), 1, 1);
  const double scale = v.cwiseAbs().dot(system.gyroscopic().cwiseAbs() * v.cwiseAbs());
  BOOST_TEST(std::abs(v.dot(system.gyroscopic() * v)) <= 1e-15 * scale * system.dofs());  // rounding of the sum
}

BOOST_AUTO_TEST_CASE(jacobian_is_the_derivative_of_the_right_hand_side) {
  for (const bool always_damped : {false, true}) {
    auto stage = fast_stage();
    stage.damping_without_contact = always_damped;
    const auto system = assemble(stage);
    const int n = system.dofs();
    // Of the order of the backlash: some meshes drive, some are open, some touch at their backs.
    Eigen::VectorXd y(2 * n), up(2 * n), down(2 * n);
    y << random_vector(n, 6e-5, 2), random_vector(n, 0.1, 3);
    auto workspace = system.workspace();
    const double t = 0.0123;
    system.detect_contact(t, y.data(), workspace);
    int states[3] = {0, 0, 0};
    for (const auto contact : workspace.contact) ++states[static_cast<int>(contact) + 1];
    BOOST_REQUIRE(states[0] > 0);
    BOOST_REQUIRE(states[1] > 0);
    BOOST_REQUIRE(states[2] > 0);
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    system.jacobian(t, y.data(), jacobian, workspace);
    for (int j = 0; j < 2 * n; ++j) {
      // In a held contact state the right-hand side is linear: the difference has rounding error only, whatever the
      // step; 1 m or m/s keeps it at eps relative to the largest entry of the column.
      const double h = 1, value = y[j];
      y[j] = value + h;
      system.rhs(t, y.data(), up.data(), workspace);
      y[j] = value - h;
      system.rhs(t, y.data(), down.data(), workspace);
      y[j] = value;
      const Eigen::VectorXd column = (up - down) / (2 * h);
      BOOST_TEST((column - jacobian.col(j)).cwiseAbs().maxCoeff() <=
                 1e-13 * (1 + jacobian.col(j).cwiseAbs().maxCoeff()));
    }
  }
}

BOOST_AUTO_TEST_CASE(right_hand_side_is_the_matrix_equation) {
  const auto system = assemble(fast_stage());
  const int n = system.dofs();
  Eigen::VectorXd y(2 * n), dy(2 * n);
  const auto q = random_vector(n, 1e-4, 4), v = random_vector(n, 0.1, 5);
  y << q, v;
  auto workspace = system.workspace();
  system.detect_contact(0.02, y.data(), workspace);
  system.rhs(0.02, y.data(), dy.data(), workspace);
  Eigen::VectorXd force = system.load() - (system.damping() + system.gyroscopic()) * v -
                          (system.stiffness() + system.rotating_stiffness()) * q;
  for (std::size_t m = 0; m < system.meshes().size(); ++m) {
    const auto b = system.mesh_vector(static_cast<int>(m));
    const auto& mesh = system.meshes()[m];
    const double delta = b.dot(q) - workspace.error[m], rate = b.dot(v) - workspace.error_rate[m];
    const double half = *mesh.half_backlash;
    const double g = delta > half ? delta - half : delta < -half ? delta + half : 0.0;
    force -= b * (workspace.stiffness[m] * g + (g != 0 ? mesh.damping * rate : 0.0));
  }
  const Eigen::VectorXd residual = system.mass() * dy.tail(n) - force;
  BOOST_TEST(residual.cwiseAbs().maxCoeff() <= 1e-13 * force.cwiseAbs().maxCoeff() * n);  // rounding of the sums
  BOOST_TEST((dy.head(n) - v).cwiseAbs().maxCoeff() == 0.0);
}

BOOST_AUTO_TEST_CASE(power_is_the_rate_of_energy) {
  const auto system = assemble(fast_stage());
  const int n = system.dofs();
  Eigen::VectorXd y(2 * n), dy(2 * n);
  y << random_vector(n, 1e-4, 6), random_vector(n, 0.1, 7);
  auto workspace = system.workspace();
  const double t = 0.0321, h = 1e-8;
  system.detect_contact(t, y.data(), workspace);
  system.rhs(t, y.data(), dy.data(), workspace);
  const auto power = system.power(t, y.data(), workspace);
  BOOST_TEST(power.dissipated > 0);
  const Eigen::VectorXd after = y + h * dy, before = y - h * dy;
  const double rate =
      (system.energy(t + h, after.data(), workspace) - system.energy(t - h, before.data(), workspace)) / (2 * h);
  // Central difference: h^2 w^3/6 E with w = 3e4 rad/s (4.6 kHz) is 5e-4 of E w per second; rounding eps E / h = 1e-8
  // E.
  const double scale = std::abs(power.supplied) + power.dissipated;
  BOOST_TEST(std::abs(rate - power.supplied + power.dissipated) <= 1e-6 * scale);
}

BOOST_AUTO_TEST_CASE(the_right_hand_side_does_not_allocate) {
  const auto table = tables::BentTable{.positions = 3}.table();
  for (const auto dependence : {LoadDependence::nominal, LoadDependence::table}) {
    auto stage = stages::ring_paper();
    stage.ring_mesh = table_stiffness(table, stage.mean_mesh_force(), 0, dependence);
    const auto system = assemble(stage);
    const int n = system.dofs();
    const Eigen::VectorXd y = random_vector(2 * n, 1e-4, 8);
    Eigen::VectorXd dy(2 * n);
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    auto workspace = system.workspace();
    const long before = allocations();
    BOOST_REQUIRE(before > 0);  // the counter is in place
    for (int i = 0; i < 10; ++i) {
      system.detect_contact(i * 1e-4, y.data(), workspace);
      system.rhs(i * 1e-4, y.data(), dy.data(), workspace);
      (void)system.power(i * 1e-4, y.data(), workspace);
      system.jacobian(i * 1e-4, y.data(), jacobian, workspace);
    }
    const long after = allocations();  // Boost.Test allocates, too
    BOOST_TEST(after == before);
  }
}

BOOST_AUTO_TEST_CASE(a_dof_without_mass_is_refused) {
  LumpedSystemBuilder builder;
  builder.add_dof("loose");
  BOOST_CHECK_THROW((void)builder.build(), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
