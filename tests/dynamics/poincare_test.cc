#include "dynamics/systems/planetary/poincare.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "tests/dynamics/stages.h"

BOOST_AUTO_TEST_SUITE(poincare)

using namespace annulus::dynamics;

/// One quantity that swings between -1 and 1, given once per mesh cycle.
template <class Function>
PoincareSection section_of(Function value, int cycles) {
  PoincareSection section{{"x"}, Eigen::MatrixXd(1, cycles), Eigen::VectorXd::Constant(1, 2.0)};
  for (int i = 0; i < cycles; ++i) section.points(0, i) = value(i);
  return section;
}

BOOST_AUTO_TEST_CASE(patterns_of_known_motions) {
  const auto wave = [](double period) {
    return [period](int i) { return std::cos(2 * std::numbers::pi * i / period); };
  };
  auto found = section_pattern(section_of([](int) { return 0.3; }, 20), 1);
  BOOST_TEST((found.kind == SectionKind::period_1));
  BOOST_TEST(found.clusters == 1);
  BOOST_TEST(*found.period == 1);

  found = section_pattern(section_of(wave(5), 55), 5);  // with the errors
  BOOST_TEST((found.kind == SectionKind::period_1));
  BOOST_TEST(found.clusters == 3);  // a cosine passes all but its ends twice
  BOOST_TEST(*found.period == 5);

  found = section_pattern(section_of(wave(3), 60), 1);
  BOOST_TEST((found.kind == SectionKind::period_n));
  BOOST_TEST(found.clusters == 2);
  BOOST_TEST(*found.period == 3);
  BOOST_TEST(found.spread <= 1e-12);

  found = section_pattern(section_of(wave(10), 60), 4);  // together after 20
  BOOST_TEST((found.kind == SectionKind::period_n));
  BOOST_TEST(*found.period == 20);

  found = section_pattern(section_of(wave(3 + std::sqrt(2.0)), 60), 1, {}, 1e-4);
  BOOST_TEST((found.kind == SectionKind::irregular));
  BOOST_TEST(!found.period.has_value());
  BOOST_TEST(found.clusters == 60);
  // The best of its shifts, 22 cycles, misses 5 periods by 0.073 cycles: 2 sin(pi 0.073/4.414) / swing at most.
  BOOST_TEST(found.spread > 1e-4);
  BOOST_TEST(found.spread < std::sin(std::numbers::pi * 0.073 / 4.414) + 1e-3);

  // A start that decays within what is known of the points is no other point.
  const auto decays = [](int i) { return i == 0 ? 0.6 : 0.0; };
  BOOST_TEST((section_pattern(section_of(decays, 20), 1).kind == SectionKind::irregular));
  found = section_pattern(section_of(decays, 20), 1, {.length = 0.7});
  BOOST_TEST((found.kind == SectionKind::period_1));
  BOOST_TEST(found.clusters == 1);

  found = section_pattern(section_of(wave(5), 55), 55);
  BOOST_TEST((found.kind == SectionKind::undecided));

  // What does not swing says nothing, however its rounding looks.
  auto still = section_of([](int i) { return 1 + 1e-15 * (i % 7); }, 40);
  still.swing[0] = 6e-15;
  BOOST_TEST((section_pattern(still, 1).kind == SectionKind::period_1));
}

// The section of a stage with constant stiffness and no damping: forces are k (deflection - half backlash).
BOOST_AUTO_TEST_CASE(section_of_a_stage) {
  auto stage = stages::ring_paper();
  stage.sun_mesh = ConstantStiffness{1.4e9};
  stage.ring_mesh = ConstantStiffness{1.9e9};
  stage.mesh_damping_ratio = 0;
  SimulationOptions options;
  options.mesh_cycles = 110;
  options.estimate_error = false;
  const auto response = simulate(stage, options);
  const auto section = poincare_section(stage, response.series, options.samples_per_cycle);
  BOOST_REQUIRE(section.points.cols() == 55);
  BOOST_REQUIRE(section.quantities.size() == 22U);
  BOOST_TEST(section.quantities[1] == "sun_y_m");
  BOOST_TEST(section.quantities[2] == "sun_planet1_deflection_m");
  BOOST_TEST(section.quantities[21] == "ring_planet5_force_N");
  for (int c = 0; c < 55; ++c) {
    BOOST_TEST(section.points(0, c) == response.series.displacement(0, 64 * c));
    for (int m = 0; m < 10; ++m) {
      const double force = (m < 5 ? 1.4e9 : 1.9e9) * (section.points(2 + m, c) - 50e-6);
      BOOST_TEST(std::abs(section.points(12 + m, c) - force) <= 1e-9 * 60e3);  // rounding of the deflection
    }
  }
  for (int m = 0; m < 10; ++m)
    BOOST_TEST(std::abs(section.swing[12 + m] / section.swing[2 + m] / (m < 5 ? 1.4e9 : 1.9e9) - 1) <= 1e-9);
}

// The forced response of the damped stage repeats with the excitation.
BOOST_AUTO_TEST_CASE(damped_stage_without_errors_is_period_1) {
  auto stage = stages::ring_paper();
  stage.planet_errors.clear();
  SimulationOptions options;
  options.estimate_error = false;
  options.steady_tolerance = 1e-5;  // the transient, mostly the sun on its soft support, far below the tolerance here
  const auto response = simulate(stage, options);
  const auto section = poincare_section(stage, response.series, options.samples_per_cycle);
  const auto pattern = section_pattern(section, stage.error_period());
  BOOST_TEST(response.steady);
  BOOST_TEST((pattern.kind == SectionKind::period_1), pattern.spread);
  BOOST_TEST(pattern.clusters == 1);
}

BOOST_AUTO_TEST_SUITE_END()
