#include "dynamics/system/mesh_excitation.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"
#include "dynamics/system/lumped_system.h"

BOOST_AUTO_TEST_SUITE(mesh_excitation)

using namespace annulus::dynamics;

annulus::PeriodicCurve ramp(int cycles, int per_cycle, double start, double step) {
  std::vector<double> values;
  for (int i = 0; i < cycles * per_cycle; ++i) values.push_back(start + step * i);
  return {values, per_cycle};
}

/// One unit mass behind one mesh.
LumpedSystem single(const MeshExcitation& excitation, double frequency, double phase_offset) {
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("u");
  mesh.excitation = excitation;
  mesh.frequency = frequency;
  mesh.phase_offset = phase_offset;
  builder.add_mass(mesh.b, 1);
  builder.add_mesh(mesh);
  return builder.build();
}

double stiffness_at(const LumpedSystem& system, double t) {
  auto workspace = system.workspace();
  system.evaluate_excitation(t, workspace);
  return workspace.stiffness[0];
}

BOOST_AUTO_TEST_CASE(harmonic_follows_its_formula) {
  const auto system = single(HarmonicStiffness{2e9, 0.25, 0.1}, 700, 0.35);
  for (const double t : {0.0, 1e-4, 0.0123, 3.7}) {
    const double expected = 2e9 * (1 + 0.25 * std::cos(2 * std::numbers::pi * (700 * t + 0.35 - 0.1)));
    // The argument reaches 2e4 rad: 2e4 eps of its cosine.
    BOOST_TEST(std::abs(stiffness_at(system, t) - expected) <= 1e-11 * 2e9);
  }
}

BOOST_AUTO_TEST_CASE(rectangular_wave_keeps_its_mean_and_jumps_where_it_says) {
  const RectangularStiffness wave{1e9, 0.35, 0.6, 0.2};
  const auto system = single(wave, 100, 0.5);  // phase 100 t + 0.3
  const double high = 1e9 * (1 + 0.35 * 0.4), low = 1e9 * (1 - 0.35 * 0.6);
  BOOST_TEST(std::abs(0.6 * high + 0.4 * low - 1e9) <= 1e-6);
  BOOST_TEST(std::abs(stiffness_at(system, 0.0029) - high) <= 1e-6);  // phase 0.59
  BOOST_TEST(std::abs(stiffness_at(system, 0.0031) - low) <= 1e-6);   // phase 0.61
  BOOST_TEST(std::abs(stiffness_at(system, 0.0071) - high) <= 1e-6);  // phase 1.01
  BOOST_TEST(std::abs(system.next_jump(0) - 0.003) <= 1e-15);
  BOOST_TEST(std::abs(system.next_jump(0.003) - 0.007) <= 1e-15);  // the jump just reached is not the next one
  BOOST_TEST(std::abs(system.next_jump(0.007) - 0.013) <= 1e-15);
  // Held over an interval, both sides of a jump can be evaluated at the jump itself.
  auto workspace = system.workspace();
  system.hold_waves(0.002, workspace);
  system.evaluate_excitation(0.003, workspace);
  BOOST_TEST(std::abs(workspace.stiffness[0] - high) <= 1e-6);
  system.hold_waves(0.005, workspace);
  system.evaluate_excitation(0.003, workspace);
  BOOST_TEST(std::abs(workspace.stiffness[0] - low) <= 1e-6);
}

BOOST_AUTO_TEST_CASE(smooth_excitations_have_no_jump) {
  BOOST_TEST(single(HarmonicStiffness{1e9, 0.1, 0}, 100, 0).next_jump(0) == std::numeric_limits<double>::infinity());
}

BOOST_AUTO_TEST_CASE(table_is_read_at_its_phase_and_its_unloaded_error_moves) {
  const auto secant = ramp(3, 4, 1e9, 1e7), te = ramp(3, 4, 0, 1e-6);
  const auto system = single(TableStiffness{secant, secant, te, 0.25}, 50, 2);
  auto workspace = system.workspace();
  const double zero = 0;
  for (const double t : {0.0, 0.011, 0.5, 7.77}) {
    const double cycles = 50 * t + 2 - 0.25;
    system.evaluate_meshes(t, &zero, &zero, workspace);
    BOOST_TEST(std::abs(workspace.stiffness[0] - secant(cycles)) <= 1e-3);  // rounding of 390 cycles x slope 1e8
    BOOST_TEST(std::abs(workspace.delta[0] + te(cycles)) <= 1e-16);
    BOOST_TEST(std::abs(workspace.delta_rate[0] + 50 * te.derivative(cycles)) <= 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(means_and_periods) {
  const TableStiffness table{ramp(3, 4, 1e9, 1e7), ramp(3, 4, 2e9, 1e7), ramp(3, 4, 0, 0), 0};
  BOOST_TEST(mean_stiffness(table) == table.secant.mean());
  BOOST_TEST(mean_tangent_stiffness(table) == table.tangent.mean());
  BOOST_TEST(period_in_cycles(table) == 3);
  BOOST_TEST(period_in_cycles(ConstantStiffness{1}) == 1);
  BOOST_TEST(mean_tangent_stiffness(RectangularStiffness{7, 0.1, 0.5, 0}) == 7.0);
}

BOOST_AUTO_TEST_CASE(table_is_taken_at_a_load) {
  std::vector<annulus::StiffnessEntry> entries;
  for (const double load : {1e3, 3e3}) entries.push_back({1e-6, 1e-6 + load / (1e9 + load), 1e9 + load, 2e9 + load, 0});
  const annulus::StiffnessTable table("sun_planet", 1, {0}, {1e3, 3e3}, entries);
  const auto excitation = table_stiffness(table, 2e3, 0.5);
  BOOST_TEST(std::abs(excitation.secant(0.3) - (1e9 + 2e3)) <= 1e-6);
  BOOST_TEST(std::abs(excitation.tangent(0.3) - (2e9 + 2e3)) <= 1e-6);
  BOOST_TEST(excitation.unloaded_te(0.3) == 1e-6);
  BOOST_TEST(excitation.phase_shift == 0.5);
  BOOST_CHECK_THROW((void)table_stiffness(table, 4e3), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(vanishing_stiffness_is_refused) {
  BOOST_CHECK_THROW(check(ConstantStiffness{0}, "m"), annulus::InputError);
  BOOST_CHECK_THROW(check(ConstantStiffness{NAN}, "m"), annulus::InputError);
  BOOST_CHECK_THROW(check(HarmonicStiffness{1, 1.0, 0}, "m"), annulus::InputError);
  BOOST_CHECK_THROW(check(RectangularStiffness{1, 0.5, 1.0, 0}, "m"), annulus::InputError);
  BOOST_CHECK_THROW(check(RectangularStiffness{1, 2.0, 0.6, 0}, "m"), annulus::InputError);
  BOOST_CHECK_NO_THROW(check(RectangularStiffness{1, 1.6, 0.6, 0}, "m"));  // low level 0.04
  const auto good = ramp(1, 4, 1e9, 1e7), bad = ramp(1, 4, -1e9, 1e9);
  BOOST_CHECK_THROW(check(TableStiffness{bad, good, good, 0}, "m"), annulus::InputError);
  BOOST_CHECK_EXCEPTION(check(ConstantStiffness{-1}, "sun mesh"), annulus::InputError,
                        [](const auto& e) { return std::string(e.what()).starts_with("sun mesh: "); });
}

BOOST_AUTO_TEST_SUITE_END()
