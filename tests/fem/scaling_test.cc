#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "fem/body/resolution.h"
#include "fem/loaded_mesh.h"
#include "tests/verification_record.h"

namespace annulus::tests::scaled {
namespace {

/// Units of length and of pressure: everything that has one is multiplied.
struct Units {
  double length = 1, pressure = 1;
};

geometry::GearParameters gear(geometry::GearKind kind, int teeth, const Units& units) {
  geometry::GearParameters p;
  p.kind = kind;
  p.teeth = teeth;
  p.module = 4e-3 * units.length;
  p.pressure_angle = 20 * M_PI / 180;
  p.face_width = 30e-3 * units.length;
  return p;
}

/// A planet of 24 teeth in a ring of 72, 100 N per mm of face width.
fem::LoadedMeshProblem ring_problem(const fem::RingStructure& structure, const Units& units) {
  auto ring = gear(geometry::GearKind::internal, 72, units);
  ring.tip_diameter = 282e-3 * units.length;
  fem::LoadedMeshProblem problem{geometry::GearPair(geometry::Gear(gear(geometry::GearKind::external, 24, units)),
                                                    geometry::Gear(ring), 96e-3 * units.length),
                                 {}};
  for (auto* material : {&problem.materials.pinion, &problem.materials.wheel})
    material->youngs_modulus *= units.pressure;
  problem.face_width = ring.face_width;
  problem.pinion_bore_radius = 22e-3 * units.length;
  problem.wheel_support_radius = 165e-3 * units.length;
  problem.structure = structure;
  problem.loads = {3000 * units.pressure * units.length * units.length};
  problem.phases = 8;
  return problem;
}

fem::PinHeld pins(const Units& units) {
  fem::PinHeld held;
  held.angles = fem::equal_angles(24, 0.01);
  held.pin_diameter = 12e-3 * units.length;
  held.clearance = 2e-6 * units.length;
  held.free_span = 5e-3 * units.length;
  return held;
}

fem::LoadedMeshResult solve(const fem::LoadedMeshProblem& problem, fem::Fidelity fidelity) {
  fem::LoadedMeshSettings settings;
  settings.fidelity = fidelity;
  settings.degree = 1;
  settings.level = 1;
  return fem::solve_loaded_mesh(problem, settings);
}

/// Gaps are differences of places some 0.1 m apart, known to 2e-17 m; deflections are micrometres: five digits less.
constexpr double same = 1e-10;
/// The shortest pressure elements, cut by tip edges, are micrometres long and differences of the same places. Where
/// units change by powers of two, and nothing is rounded anew, that does not count.
constexpr double same_pressure = 1e-8;
const double million = std::ldexp(1.0, 20);

bool is_power_of_two(double factor) {
  int exponent = 0;
  return std::frexp(factor, &exponent) == 0.5;
}

template <class Structure>
void check_scaling(const Structure& structure, fem::Fidelity fidelity) {
  const auto nominal = solve(ring_problem(structure(Units{}), Units{}), fidelity);
  for (const Units units : {Units{1e6, 1}, Units{1e-6, 1}, Units{1, 1e6}, Units{1, 1e-6}, Units{million, 1},
                            Units{1 / million, 1}, Units{1, million}, Units{1, 1 / million}}) {
    const bool exact = is_power_of_two(units.length) && is_power_of_two(units.pressure);
    BOOST_TEST_CONTEXT("lengths x " << units.length << ", pressures x " << units.pressure) {
      const auto scaled = solve(ring_problem(structure(units), units), fidelity);
      BOOST_TEST_REQUIRE(scaled.positions.size() == nominal.positions.size());
      const double line_stiffness = units.pressure * units.length;
      double worst = 0, worst_pressure = 0;
      for (std::size_t i = 0; i < scaled.positions.size(); ++i) {
        const auto &a = nominal.positions[i], &b = scaled.positions[i];
        const auto differ = [&](double x, double y, double scale) {
          worst = std::max(worst, std::abs(y / scale - x) / std::abs(x));
        };
        differ(a.entry.lte, b.entry.lte, units.length);
        differ(a.entry.stiffness_secant, b.entry.stiffness_secant, line_stiffness);
        differ(a.entry.stiffness_tangent, b.entry.stiffness_tangent, line_stiffness);
        worst_pressure =
            std::max(worst_pressure, std::abs(b.max_pressure / units.pressure - a.max_pressure) / a.max_pressure);
        BOOST_TEST_REQUIRE(a.pair_share.size() == b.pair_share.size());
        for (std::size_t p = 0; p < a.pair_share.size(); ++p)
          worst = std::max(worst, std::abs(a.pair_share[p] - b.pair_share[p]));
      }
      BOOST_TEST(worst < same);
      BOOST_TEST(worst_pressure < (exact ? same : same_pressure));
      BOOST_TEST_MESSAGE("lengths x " << units.length << ", pressures x " << units.pressure << ": " << worst
                                      << ", peak pressures " << worst_pressure);
      BOOST_TEST(scaled.worst_error_relative == nominal.worst_error_relative, boost::test_tools::tolerance(1e-6));
    }
  }
}

const auto held = [](const Units&) -> fem::RingStructure { return fem::OutsideHeld{}; };
const auto pinned = [](const Units& units) -> fem::RingStructure { return pins(units); };
const auto splined = [](const Units& units) -> fem::RingStructure {
  fem::SplineHeld spline;
  spline.teeth = 72;
  spline.flank_angle = 0.5;
  spline.clearance = 1e-6 * units.length;
  return spline;
};
const auto sleeve = [](const Units& units) -> fem::RingStructure {
  fem::EndFaceHeld face;
  face.free_length = 10e-3 * units.length;
  face.sleeve_thickness = 8e-3 * units.length;
  return face;
};

}  // namespace
}  // namespace annulus::tests::scaled

BOOST_AUTO_TEST_SUITE(scaling)

using namespace annulus;
using namespace annulus::tests::scaled;

BOOST_AUTO_TEST_CASE(formulas_of_a_held_ring) { check_scaling(held, fem::Fidelity::closed_form); }
BOOST_AUTO_TEST_CASE(formulas_of_a_ring_on_pins) { check_scaling(pinned, fem::Fidelity::closed_form); }
BOOST_AUTO_TEST_CASE(formulas_of_a_ring_in_splines) { check_scaling(splined, fem::Fidelity::closed_form); }
BOOST_AUTO_TEST_CASE(plane_elements_of_a_held_ring) { check_scaling(held, fem::Fidelity::plane); }
BOOST_AUTO_TEST_CASE(plane_elements_of_a_ring_on_pins) { check_scaling(pinned, fem::Fidelity::plane); }
BOOST_AUTO_TEST_CASE(solid_elements_of_a_ring_on_a_sleeve) { check_scaling(sleeve, fem::Fidelity::solid); }

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(limits)

using namespace annulus;
using namespace annulus::tests::scaled;

double nominal_lte(const fem::LoadedMeshResult& result) { return result.table.at(0, 0, 0).lte; }

/// Ever more stiff bolts become the held surface, from below.
BOOST_AUTO_TEST_CASE(bolts_without_number_are_the_held_surface) {
  test::Verification record("18, 72 and 288 stiff bolts, side by side", "limit: the held surface, from below");
  for (const auto fidelity : {fem::Fidelity::closed_form, fem::Fidelity::plane}) {
    const double held = nominal_lte(solve(ring_problem(fem::OutsideHeld{}, Units{}), fidelity));
    double before = 1;
    for (const int bolts : {18, 72, 288}) {
      fem::PinHeld pins;
      pins.angles = fem::equal_angles(bolts, 0);
      pins.pin_diameter = 2 * M_PI * 165e-3 / bolts;  // they touch
      pins.unilateral = false;
      pins.radial_stiffness = 1e14;
      const double away = nominal_lte(solve(ring_problem(pins, Units{}), fidelity)) / held - 1;
      BOOST_TEST(away > 0);
      BOOST_TEST(away < before / 2);
      before = away;
    }
    record.at_most(fidelity == fem::Fidelity::plane ? "288 bolts, plane elements: transmission error over held - 1"
                                                    : "288 bolts, formulas: transmission error over held - 1",
                   "", before, 5e-3, "ceiling; each step more than halves it");
  }
}

/// The deflection falls with the length of the sleeve, in the end in proportion, to that without a sleeve.
BOOST_AUTO_TEST_CASE(a_sleeve_without_length_is_none) {
  test::Verification record("A ring on ever shorter sleeves, solid elements",
                            "limit: no sleeve, in proportion to the length in the end");
  const auto lte = [&](double length) {
    fem::EndFaceHeld face;
    face.free_length = length;
    face.sleeve_thickness = 8e-3;
    return nominal_lte(solve(ring_problem(face, Units{}), fem::Fidelity::solid));
  };
  const double none = lte(0), long_sleeve = lte(100e-3);
  const double tenth = lte(1e-4) - none, hundredth = lte(1e-5) - none;
  record.close("transmission error, sleeve of 1 nm against none", "m", lte(1e-9), none, 1e-6,
               "in proportion to the length");
  BOOST_TEST(hundredth > 0);
  record.close("added deflection, 0.1 mm over 0.01 mm", "", tenth / hundredth, 10, 0.1, "proportional in the end only");
  BOOST_TEST(long_sleeve > 2 * none);
}

BOOST_AUTO_TEST_SUITE_END()
