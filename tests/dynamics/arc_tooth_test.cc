#include "dynamics/systems/two_k_v/arc_tooth.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/system/mesh_excitation.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(arc_tooth)

using namespace annulus::dynamics;

// The handbook's form with the Hertz width written out; rounding.
BOOST_AUTO_TEST_CASE(deflection_is_the_line_contact_formula) {
  annulus::test::Verification record("Approach of pin and arc tooth",
                                     "handbook: line contact of cylinders with the Hertz width written out");
  const auto mesh = stages::arc_mesh();
  for (const double force : {1.0, 100.0, 500.0}) {
    const double elastic = 2 * (1 - 0.3 * 0.3) / 2.06e11, line = force / 8e-3;
    const double relative = 1 / (1 / 2e-3 - 1 / 2.2e-3);
    const double half_width = std::sqrt(4 * line * relative * elastic / std::numbers::pi);
    const double width = 2 * half_width;
    const double expected =
        elastic * line / std::numbers::pi * (2.0 / 3 + std::log(16 * 2e-3 * 2.2e-3 / (width * width)));
    record.near("approach", "m", pin_deflection(mesh, force), expected, 1e-13 * expected, "rounding");
  }
}

// Johnson (5.57), each body from the contact to its centre: d = (1 - nu^2)/(pi E) F' (2 ln(4R/a) - 1).
BOOST_AUTO_TEST_CASE(johnson_constant_is_the_sum_of_both_bodies) {
  annulus::test::Verification record("Approach of pin and arc tooth by Johnson's constant",
                                     "Johnson, Contact Mechanics, eq. 5.57, each body from the contact to its centre");
  auto mesh = stages::arc_mesh();
  mesh.approach = LineApproach::johnson;
  const double force = 200, line = force / 8e-3, one = (1 - 0.09) / (std::numbers::pi * 2.06e11);
  const double half_width =
      std::sqrt(4 * line / std::numbers::pi * 2 * (1 - 0.09) / 2.06e11 * mesh.equivalent_radius());
  const double expected =
      one * line * (2 * std::log(4 * 2e-3 / half_width) - 1) + one * line * (2 * std::log(4 * 2.2e-3 / half_width) - 1);
  record.near("approach", "m", pin_deflection(mesh, force), expected, 1e-13 * expected, "rounding");
  // The handbook's constant stands for another depth of the bodies: a few percent.
  const double handbook = pin_deflection(stages::arc_mesh(), force);
  BOOST_TEST(handbook > expected);
  BOOST_TEST(handbook < 1.05 * expected);
}

BOOST_AUTO_TEST_CASE(force_and_tangent_belong_to_the_deflection) {
  annulus::test::Verification record("Force and tangent stiffness of a pin", "inverse and slope of its approach");
  const auto mesh = stages::arc_mesh();
  for (const double force : {1e-3, 1.0, 300.0}) {
    const double w = pin_deflection(mesh, force);
    record.near("force over the given one", "", pin_force(mesh, w) / force, 1, 1e-12, "50 bits");
    const double step = 1e-4 * force;  // central difference: step^2/F^2 of the curvature, 1e-9
    const double slope = 2 * step / (pin_deflection(mesh, force + step) - pin_deflection(mesh, force - step));
    record.near("tangent over the slope", "", pin_tangent(mesh, force) / slope, 1, 1e-8, "second order of the step");
  }
}

BOOST_AUTO_TEST_CASE(gear_is_in_equilibrium) {
  annulus::test::Verification record("Equilibrium of an arc gear among its pins",
                                     "statics; tangent stiffness as the difference of two equilibria");
  for (const double clearance : {0.0, 1e-6}) {
    auto mesh = stages::arc_mesh();
    mesh.clearance = clearance;
    for (const double phase : {0.0, 0.2, 0.77}) {
      const auto position = arc_position(mesh, 29, phase);
      record.near("torque of the pins", "N m", position.lever.dot(position.force), 29, 1e-11 * 29, "rounding");
      // dT/d(delta)/r' at the solution against a difference of two equilibria, 1e-4 of the torque: second order.
      const double rise = arc_position(mesh, 29 * 1.0001, phase).deflection;
      const double fall = arc_position(mesh, 29 * 0.9999, phase).deflection;
      const double tangent = 2e-4 * 29 / mesh.pitch_radius() / (rise - fall);
      record.near("tangent stiffness", "N/m", position.tangent, tangent, 1e-6 * tangent,
                  "second order of a step of 1e-4");
    }
  }
}

// The mean of sin^2 beta over the circle is 1/2 whatever the pole, so half the pins of equal stiffness k give k z_b/4:
// what (3) assumes. The sum over 30 pins differs from the integral by the kink of sin^2 at the ends of the half.
BOOST_AUTO_TEST_CASE(levers_add_up_to_a_quarter_of_the_pins) {
  annulus::test::Verification record("Stiffness of half of the pins together",
                                     "mean of sin^2 over the circle: k z_b / 4, the assumption of the printed formula");
  const auto mesh = stages::arc_mesh();
  for (const double phase : {0.0, 0.3, 0.5}) {
    const auto position = arc_position(mesh, 29, phase);
    const double sum = position.lever.squaredNorm() / std::pow(mesh.pitch_radius(), 2);
    record.near("sum of squared levers over the radius squared, 30 pins", "", sum, 7.5, 2e-3 * 7.5,
                "sum against integral: kink of sin^2 at the ends of the half");
    BOOST_TEST(position.lever.minCoeff() == 0.0);
    BOOST_TEST(position.lever.maxCoeff() <= mesh.pitch_radius());
  }
}

// The printed stiffness takes the secant of the most loaded pin for all. A pin with less load is softer (the
// logarithm): the sum lies below, by less than a tenth.
BOOST_AUTO_TEST_CASE(sum_of_pins_against_the_printed_formula) {
  annulus::test::Verification record("Sum of the pins against the printed formulas",
                                     "the paper's largest pin force and mesh stiffness (docs/arc_tooth_2kv.md)");
  const auto mesh = stages::arc_mesh();
  const double torque = uneven_share * 58, printed = printed_stiffness(mesh, torque);
  const auto position = arc_position(mesh, torque, 0.1);
  record.at_least("stiffness of all pins over the printed one", "", position.secant / printed, 0.9,
                  "pins with less load are softer, by less than a tenth");
  BOOST_TEST(position.secant < printed);
  BOOST_TEST(position.tangent > position.secant);
  BOOST_TEST(position.force.maxCoeff() > largest_pin_force(mesh, torque));
  BOOST_TEST(position.force.maxCoeff() < 1.1 * largest_pin_force(mesh, torque));
  // F_max = 4 x 31.9 N m/(30 x 26.1 mm)
  record.near("printed largest pin force: 4 x 31.9 N m / (30 x 26.1 mm)", "N", largest_pin_force(mesh, torque), 162.96,
              0.01, "its digits");
}

BOOST_AUTO_TEST_CASE(clearance_leaves_few_pins) {
  annulus::test::Verification record("Pins that carry with clearances of 0, 5 um and 1 mm",
                                     "half of 30 pins, fewer, one alone under its lever");
  auto mesh = stages::arc_mesh();
  const auto tight = arc_position(mesh, 29, 0.3);
  record.near("pins that carry, no clearance", "", tight.loaded, 15, 0, "half of 30");
  record.near("displacement at which the first touches, no clearance", "m", tight.touch, 0, 0, "all touch at once");
  mesh.clearance = 5e-6;
  const auto loose = arc_position(mesh, 29, 0.3);
  record.at_most("pins that carry, 5 um", "", loose.loaded, 9, "fewer than ten");
  record.at_least("displacement at which the first touches over the clearance, 5 um", "", loose.touch / mesh.clearance,
                  1, "the clearance along the normal of a flank");
  record.at_most("stiffness with 5 um over that without", "", loose.secant / tight.secant, 1, "fewer pins are softer");
  BOOST_TEST(loose.secant < tight.secant);
  mesh.clearance = 1e-3;  // one pin alone: its own law under the lever
  const auto single = arc_position(mesh, 1, 0.3);
  record.near("pins that carry, 1 mm", "", single.loaded, 1, 0, "one alone");
  const double sine = single.lever.maxCoeff() / mesh.pitch_radius();
  const double force = 1 / (mesh.pitch_radius() * sine);
  record.near("force on the one pin: torque over its lever", "N", single.force.maxCoeff(), force, 1e-9 * force,
              "rounding of the solve");
}

BOOST_AUTO_TEST_CASE(table_repeats_with_every_pin) {
  annulus::test::Verification record("Stiffness table of arc teeth on pins",
                                     "it repeats with every pin, and holds what a position gives");
  auto mesh = stages::arc_mesh();
  mesh.clearance = 1e-6;
  const auto table = arc_stiffness_table(mesh, {10, 29, 60}, 16);
  record.close("secant stiffness three pins on", "N/m", arc_position(mesh, 29, 3.25).secant,
               arc_position(mesh, 29, 0.25).secant, 1e-10, "rounding of the solve");
  const double load = 29 / mesh.pitch_radius();
  const auto excitation = table_stiffness(table, load);
  record.near("secant stiffness of the table", "N/m", excitation.secant(0.25), arc_position(mesh, 29, 0.25).secant,
              1e-9 * excitation.secant.mean(), "rounding of the solve");
  BOOST_CHECK_NO_THROW(check(excitation, "arc mesh"));
  BOOST_CHECK_NO_THROW(check(table_stiffness(table, load, 0, LoadDependence::table), "arc mesh"));
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  const auto refused = [](auto change) {
    auto mesh = stages::arc_mesh();
    change(mesh);
    BOOST_CHECK_THROW((void)arc_position(mesh, 29, 0), annulus::InputError);
  };
  refused([](auto& m) { m.pins = 2; });
  refused([](auto& m) { m.arc_radius = m.pin_radius; });
  refused([](auto& m) { m.pin_circle_radius = 27e-3; });
  refused([](auto& m) { m.width = 0; });
  refused([](auto& m) { m.clearance = -1e-9; });
  refused([](auto& m) { m.poisson_ratio = 0.5; });
  BOOST_CHECK_THROW((void)arc_position(stages::arc_mesh(), 0, 0), annulus::InputError);
  auto conforming = stages::arc_mesh();
  conforming.arc_radius = 2e-3 * (1 + 1e-6);
  BOOST_CHECK_THROW((void)pin_deflection(conforming, 200), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
