#include "dynamics/systems/helical_pair/helical_pair.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/time_integration/integrate.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(helical_pair)

using namespace annulus;
using namespace annulus::dynamics;

const auto rounding = boost::test_tools::tolerance(1e-10);

double hertz(double stiffness, double mass) { return std::sqrt(stiffness / mass) / (2 * std::numbers::pi); }

double rotational_mass(const PairGear& g) { return g.inertia / (g.radius * g.radius); }

BOOST_AUTO_TEST_CASE(turning_costs_nothing) {
  test::Verification record("Resonance of the helical pair of the paper",
                            "the natural frequency near 1.3 kHz of the paper's pair (docs/helical_pair.md)");
  const auto pair = pairs::error_paper();
  const auto system = assemble(pair);
  BOOST_REQUIRE(system.dofs() == 6);
  const Eigen::MatrixXd k = stiffness_with_meshes(system, Eigen::VectorXd::Constant(1, mean_stiffness(pair.mesh)));
  BOOST_TEST((k - k.transpose()).cwiseAbs().maxCoeff() <= 1e-15 * k.cwiseAbs().maxCoeff());
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(6);
  turn[system.find("pinion_u")] = 1;
  turn[system.find("wheel_u")] = -1;
  BOOST_TEST((k * turn).cwiseAbs().maxCoeff() <= 1e-15 * k.cwiseAbs().maxCoeff());
  const auto found = modes(pair).modes;
  BOOST_TEST(found[0].frequency == 0.0);
  BOOST_TEST(found[1].frequency > 100.0);
  // docs/helical_pair.md: the resonance near 1.3 kHz.
  record.close("highest natural frequency", "Hz", found[5].frequency, 1300.0, 0.03, "given as near 1.3 kHz");
}

BOOST_AUTO_TEST_CASE(static_equilibrium_is_the_compliance_in_line) {
  test::Verification record("Static deflection of a helical pair on unlike bearings",
                            "statics: force over stiffness, sums of compliances");
  const char* origin = "rounding of the solve";
  auto pair = pairs::error_paper();
  pair.wheel.bearing_axial = 3e8;  // unlike bearings
  pair.pinion.bearing_transverse = 5e8;
  const auto system = assemble(pair);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const double t = 0.3 / pair.mesh_frequency(), force = pair.static_force();
  const Eigen::VectorXd q = solver.solve(t, workspace);
  const double c = std::cos(pair.base_helix_angle), s = std::sin(pair.base_helix_angle);
  record.close("mesh force", "N", workspace.force[0], force, 1e-10, origin);
  record.close("pinion, line of action", "m", q[system.find("pinion_y")], -force * c / 5e8, 1e-10, origin);
  record.close("wheel, line of action", "m", q[system.find("wheel_y")], force * c / 2e9, 1e-10, origin);
  record.close("pinion, axis", "m", q[system.find("pinion_z")], force * s / 1e9, 1e-10, origin);
  record.close("wheel, axis", "m", q[system.find("wheel_z")], -force * s / 3e8, 1e-10, origin);
  const double k = mean_stiffness(pair.mesh) * (1 + 0.05 * std::cos(2 * std::numbers::pi * 0.3));
  const double e = 13.1e-6 * std::sin(2 * std::numbers::pi * 0.3);
  const double compliance = pair.static_compliance() - 1 / mean_stiffness(pair.mesh) + 1 / k;
  record.close("rotations", "m", q[system.find("pinion_u")] + q[system.find("wheel_u")], (force * compliance + e) / c,
               1e-10, origin);
  // The thrust is that of statics at the reference circle: T tan(beta) / r.
  const double thrust = pair.pinion_torque * std::tan(pairs::helix) / pairs::reference_radius(21);
  record.close("axial thrust: T tan(beta) / r", "N", force * s, thrust, 1e-10, origin);
}

BOOST_AUTO_TEST_CASE(held_bearings_leave_the_torsional_pair) {
  test::Verification record("Torsional frequency of a helical pair in held bearings",
                            "closed form: sqrt(k cos^2 b / m), m of both inertias in series");
  const auto pair = pairs::held(pairs::error_paper());
  const auto found = modes(pair);
  BOOST_REQUIRE(found.modes.size() == 2);
  const double c = std::cos(pair.base_helix_angle);
  BOOST_TEST(found.modes[0].frequency == 0.0);
  record.close("natural frequency", "Hz", found.modes[1].frequency,
               hertz(mean_stiffness(pair.mesh) * c * c, pair.reduced_mass()), 1e-10, "rounding");
  const double m1 = rotational_mass(pair.pinion), m2 = rotational_mass(pair.wheel);
  BOOST_TEST(pair.reduced_mass() == m1 * m2 / (m1 + m2), rounding);
}

BOOST_AUTO_TEST_CASE(spur_teeth_do_not_push_along_the_axis) {
  test::Verification record("A helical pair without helix angle",
                            "spur teeth: no axial force; each gear on its axial bearing alone");
  auto pair = pairs::error_paper();
  pair.base_helix_angle = 0;
  const auto system = assemble(pair);
  const auto b = system.mesh_vector(0);
  record.near("axial part of the mesh vector", "", b[system.find("pinion_z")], 0, 0, "sine of zero");
  record.near("axial part of the mesh vector", "", b[system.find("wheel_z")], 0, 0, "sine of zero");
  int axial = 0;
  for (const auto& mode : modes(pair).modes)
    for (const auto* gear : {&pair.pinion, &pair.wheel})
      if (std::abs(mode.frequency / hertz(gear->bearing_axial, gear->mass) - 1) < 1e-10) ++axial;
  record.near("modes of a gear on its axial bearing", "", axial, 2, 0, "one for each gear");
}

BOOST_AUTO_TEST_CASE(energy_is_constant_without_dampers) {
  test::Verification record("Energy of a helical pair without losses", "conservation of energy");
  auto pair = pairs::error_paper();
  pair.mesh_damping_ratio = pair.bearing_damping_ratio = 0;
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  pair.mesh_error = {};
  pair.pinion_torque = 0;
  const auto system = assemble(pair);
  auto workspace = system.workspace();
  Eigen::VectorXd y = stages::random_state(6, 4);
  const double before = system.energy(0, y.data(), workspace);
  SystemState state;
  state.q = y.head(6);
  state.v = y.tail(6);
  IntegratorOptions options;
  options.relative_tolerance = 1e-10;
  integrate(system, state, 0.1, options, workspace);
  y << state.q, state.v;
  // 130 periods of the fastest mode at 1e-10 per step of a tenth of it.
  record.close("energy after 0.1 s", "J", system.energy(state.time, y.data(), workspace), before, 1e-7,
               "130 periods of the fastest mode, 1e-10 per step of a tenth of it");
}

BOOST_AUTO_TEST_CASE(periods_and_formulas) {
  test::Verification record("Formulas of a helical pair", "ISO 21771; ISO 6336-1 (mesh stiffness, method B)");
  auto pair = pairs::error_paper();
  BOOST_TEST(pair.error_period() == 1);
  pair.pinion.error = {1e-6, 0};
  BOOST_TEST(pair.error_period() == 21);
  pair.wheel.error = {1e-6, 0};
  BOOST_TEST(pair.error_period() == 21 * 37);
  BOOST_TEST(pair.mesh_frequency() == 525.0, rounding);
  BOOST_TEST(pair.wheel_speed() * pair.wheel_torque() == pair.pinion_speed * pair.pinion_torque, rounding);
  // tan b = tan(beta) cos(transverse pressure angle)
  record.close("tan of the base helix angle", "", std::tan(pair.base_helix_angle),
               std::tan(pairs::helix) * std::cos(pairs::transverse_pressure()), 1e-10, "rounding");
  // 14 N/(mm um) cos 14 deg (0.75 1.6 + 0.25) x 150 mm = 2.955 kN/um
  record.close("mesh stiffness: 14 N/(mm um) cos 14 deg (0.75 x 1.6 + 0.25) x 150 mm", "N/m",
               iso_6336_mesh_stiffness({0.15, 1.6, pairs::helix}), 2.95455e9, 1e-5, "digits of the reference");
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  const auto refused = [](auto change) {
    auto pair = pairs::error_paper();
    change(pair);
    BOOST_CHECK_THROW((void)assemble(pair), InputError);
  };
  refused([](HelicalPair& p) { p.pinion.mass = 0; });
  refused([](HelicalPair& p) { p.wheel.bearing_transverse = 0; });
  refused([](HelicalPair& p) { p.wheel.radius *= 1.01; });
  refused([](HelicalPair& p) { p.base_helix_angle = std::numbers::pi / 2; });
  refused([](HelicalPair& p) { p.mesh = ConstantStiffness{-1}; });
  refused([](HelicalPair& p) { p.pinion_torque = std::nan(""); });
  refused([](HelicalPair& p) { p.mesh_error.phase = std::nan(""); });
  refused([](HelicalPair& p) { p.half_backlash = -1e-6; });
  BOOST_CHECK_THROW((void)iso_6336_mesh_stiffness({0.15, 0.9, 0}), InputError);
  BOOST_CHECK_THROW((void)iso_6336_mesh_stiffness({0, 1.6, 0}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
