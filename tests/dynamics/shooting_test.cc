#include "dynamics/steady_state/shooting.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(shooting)

using namespace annulus::dynamics;

constexpr double mass = 2, stiffness = 8e6, damping = 40, frequency = 250, amount = 1e-6, load = 30;

/// A mass on a mesh with a harmonic error and a steady load.
LumpedSystem oscillator() {
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("mass_x");
  builder.add_mass(x, mass);
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = x;
  mesh.excitation = ConstantStiffness{stiffness};
  mesh.frequency = frequency;
  mesh.damping = damping;
  mesh.errors.push_back({amount, 2 * std::numbers::pi * frequency, 0});
  builder.add_mesh(mesh);
  builder.add_load(x, load);
  return builder.build();
}

ShootingOptions options() {
  ShootingOptions o;
  o.displacement = 1e-6;
  o.rate = 2 * std::numbers::pi * frequency;
  o.tolerance = 1e-13;
  o.integrator.relative_tolerance = 1e-9;
  o.integrator.absolute_tolerance = 1e-16;
  return o;
}

// Forced vibration and free decay in closed form.
BOOST_AUTO_TEST_CASE(linear_oscillator) {
  annulus::test::Verification record("Periodic state by shooting: one mass under a harmonic error",
                                     "closed form: forced vibration and free decay");
  const auto system = oscillator();
  const double period = 1 / frequency, w = 2 * std::numbers::pi * frequency;
  const auto found = shoot(system, period, {0, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}, options());
  BOOST_TEST(found.converged);
  BOOST_TEST(found.iterations <= 2);
  const std::complex<double> spring(stiffness, w * damping);
  const std::complex<double> response = amount * spring / (spring - mass * w * w);  // e = Im(amount exp(i w t))
  const double q = load / stiffness + response.imag(), v = w * response.real();
  // The disturbance and the decay of 1 % per period multiply the integrator's 1e-9 by some hundred.
  const char* origin = "integrator's 1e-9, multiplied by disturbance and slow decay";
  record.near("displacement", "m", found.start.q[0], q, 1e-6 * std::abs(q), origin);
  record.near("velocity", "m/s", found.start.v[0], v, 1e-6 * w * amount, origin);
  record.near("Floquet multiplier", "", std::abs(found.multipliers[0]), std::exp(-damping / (2 * mass) * period), 1e-7,
              origin);
}

// A free body: its rigid motion stays where the guess has it.
BOOST_AUTO_TEST_CASE(rigid_motion_stays) {
  annulus::test::Verification record("Shooting on two free bodies", "closed form: static deflection; multiplier 1");
  LumpedSystemBuilder builder;
  const auto x = builder.add_dof("one_x"), y = builder.add_dof("two_x");
  builder.add_mass(x, 1);
  builder.add_mass(y, 1);
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = x + (-1.0) * y;
  mesh.excitation = ConstantStiffness{stiffness};
  mesh.frequency = frequency;
  mesh.damping = damping;
  builder.add_mesh(mesh);
  builder.add_load(x, load);
  builder.add_load(y, -load);
  const auto found =
      shoot(builder.build(), 1 / frequency, {0, Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2)}, options());
  BOOST_TEST(found.converged);
  record.near("deflection", "m", found.start.q[0] - found.start.q[1], load / stiffness, 1e-6 * load / stiffness,
              "integrator");
  BOOST_TEST(std::abs(found.start.q.sum()) <= 1e-6 * load / stiffness);
  record.at_most("distance of the second multiplier from 1", "", std::abs(found.multipliers[1] - 1.0), 1e-4,
                 "a double root: square root of the accuracy");
}

BOOST_AUTO_TEST_SUITE_END()
