#include "dynamics/steady_state/floquet.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/lumped_system.h"
#include "tests/verification_record.h"

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double body_mass = 0.3, mean = 2e8, ripple = 0.3, load = 1000;

/// A mass on a mesh of harmonic stiffness whose teeth never part; `damping` in N s/m.
LumpedSystem oscillator(double frequency, double damping) {
  LumpedSystemBuilder builder;
  const auto u = builder.add_dof("u");
  builder.add_mass(u, body_mass);
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = u;
  mesh.excitation = HarmonicStiffness{mean, ripple, 0};
  mesh.frequency = frequency;
  mesh.damping = damping;
  builder.add_mesh(mesh);
  builder.add_load(u, load);
  return builder.build();
}

double largest_multiplier(const LumpedSystem& system, double period, Eigen::Index samples) {
  SampledMeshes meshes(system, period, samples);
  Eigen::MatrixXd approach, rate, force;
  meshes.at_deflection(Eigen::VectorXd::Constant(1, load / mean), approach, rate);
  meshes.evaluate(approach, rate, force);
  return std::abs(floquet_multipliers(system, Eigen::VectorXd::Constant(1, mean), meshes, period)[0]);
}

const double natural = std::sqrt(mean / body_mass) / (2 * std::numbers::pi);

}  // namespace

BOOST_AUTO_TEST_SUITE(floquet)

// Far above the mesh frequency a mode is damped as in free vibration: the determinant of the map over a cycle is
// exp(-c T / m) (Liouville), and its two multipliers are conjugate.
BOOST_AUTO_TEST_CASE(fast_modes_of_slow_meshes_decay_as_their_dampers_say) {
  annulus::test::Verification record("Stability of a mass on a slow mesh: hundreds of vibrations in a mesh cycle",
                                     "Liouville's formula: both multipliers are exp(-c T / 2m) away from resonances");
  for (const double vibrations : {31.7, 32.1, 63.9, 64.2, 200.3, 511.9, 900.6}) {
    const double period = vibrations / natural, decay = 0.4;
    const auto system = oscillator(1 / period, 2 * body_mass * decay / period);
    for (const Eigen::Index samples : {32, 64, 256})
      record.close("multiplier", "", largest_multiplier(system, period, samples), std::exp(-decay), 1e-10,
                   "rounding of some thousand products: impulses keep the determinant");
  }
}

// Mathieu's equation at twice the natural frequency: without damping disturbances grow by exp(ripple w T / 4) in the
// first order of the ripple.
BOOST_AUTO_TEST_CASE(principal_resonance_grows) {
  annulus::test::Verification record("Principal parametric resonance of a mass on a mesh",
                                     "Mathieu's equation, first order of the ripple: exp(ripple w T / 4)");
  const double period = 0.5 / natural;
  const auto system = oscillator(1 / period, 0);
  record.close("multiplier", "", largest_multiplier(system, period, 256), std::exp(ripple * std::numbers::pi / 4), 0.01,
               "second order of the ripple, (ripple / 4)^2, and its phase over half a cycle");
}

// The harmonic balance of a slow mesh stands: time integration finds the same forces.
BOOST_AUTO_TEST_CASE(slow_meshes_have_a_periodic_motion) {
  const double period = 100.3 / natural;
  const auto system = oscillator(1 / period, 2 * 0.02 * std::sqrt(mean * body_mass));
  SteadyProblem problem{.mesh_frequency = 1 / period, .period_in_cycles = 1, .force_scale = load, .stiffness = mean};
  const auto found = steady_response(system, problem, {});
  BOOST_TEST(found.steady);
  BOOST_TEST_REQUIRE(found.periodic.has_value());
  BOOST_TEST(found.periodic->trouble == "");
  BOOST_TEST(found.periodic->largest_multiplier.value() < 1);
}

BOOST_AUTO_TEST_SUITE_END()
