#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/loaded_mesh.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(pinned_ring)

using namespace annulus::tests;
using annulus::fem::LoadedMeshResult;

constexpr double first_pin = 0.03;  // rad: no symmetry with the teeth

/// 24 pins that may lift off, the ring paper's; two positions per mesh cycle. Solved once for all cases.
const LoadedMeshResult& pinned() {
  static const LoadedMeshResult result = solve_plane(ring_mesh(paper_pins(24, first_pin), 2));
  return result;
}

BOOST_AUTO_TEST_CASE(balances_hold_at_every_position) {
  annulus::test::Verification record("Balances of a ring on 24 pins that may lift off", invariants_reference);
  check_invariants(pinned(), &record);
  BOOST_TEST(pinned().table.positions() == 27);  // 162 / gcd(162, 24)
}

BOOST_AUTO_TEST_CASE(the_pins_carry_what_the_planet_presses_on_the_ring) {
  annulus::test::Verification record("Forces on 24 pins that may lift off",
                                     "statics: the planet's force along the line of action, its torque");
  const auto problem = ring_mesh(paper_pins(24, first_pin), 2);
  const double alpha = problem.pair.working_pressure_angle();
  double worst_size = 0, worst_angle = 0, worst_moment = 0;
  int lifted = 0;
  for (const auto& p : pinned().positions) {
    BOOST_TEST_REQUIRE(p.pins.size() == 24U);
    for (const auto& pin : p.pins) {
      BOOST_TEST(pin.radial_force >= 0);
      BOOST_TEST(pin.touching == (pin.radial_force > 0));
      lifted += !pin.touching;
    }
    const auto felt = pin_resultant(p, first_pin);
    worst_size = std::max(worst_size, std::abs(felt.force / p.load - 1));
    worst_angle = std::max(worst_angle, std::abs(felt.direction - alpha));
    worst_moment = std::max(worst_moment, std::abs(felt.torque / p.load / problem.pair.wheel().base_radius() - 1));
  }
  BOOST_TEST_MESSAGE("size " << worst_size << ", direction " << worst_angle << " rad, moment " << worst_moment);
  BOOST_TEST(lifted > 0);
  // The teeth bend by about 10 micrometres over their height of 9 mm: contacts shift along the flanks and their normals
  // turn by some 1e-3 rad, differently for each pair; the sum of their forces loses the square of that in size, a few
  // times as much when a third pair bears at its tip edge.
  record.at_most("direction of the resultant, error", "rad", worst_angle, 3e-3,
                 "teeth bend by 10 um over 9 mm and turn the normals");
  record.at_most("size of the resultant, relative error", "", worst_size, 5e-5, "square of that, a few times");
  record.at_most("torque, relative error", "", worst_moment, 1e-8, "fourth power of the half arc of a pin");
}

BOOST_AUTO_TEST_CASE(turning_the_pins_by_a_tooth_shifts_the_table) {
  annulus::test::Verification record("Pins turned by a tooth", "symmetry: the table is shifted by a ring position");
  const auto problem = ring_mesh(paper_pins(24, first_pin), 2);
  const double pitch = problem.pair.wheel().pitch_angle();
  const auto turned = solve_plane(ring_mesh(paper_pins(24, first_pin + pitch), 2));
  const auto& table = pinned().table;
  BOOST_TEST(table.ring_angles()[1] - table.ring_angles()[0] == pitch, boost::test_tools::tolerance(1e-12));
  double worst = 0, least = 1, most = 0;
  for (int i = 0; i < 27; ++i)
    for (int phase = 0; phase < 2; ++phase) {
      const double lte = table.at(i, phase, 0).lte;
      worst = std::max(worst, std::abs(turned.table.at((i + 1) % 27, phase, 0).lte / lte - 1));
      if (phase == 0) least = std::min(least, lte), most = std::max(most, lte);
    }
  record.at_most("transmission error, largest relative difference", "", worst, 1e-9, "rounding");
  BOOST_TEST(most / least > 1.1);  // otherwise any shift would do
}

BOOST_AUTO_TEST_CASE(the_ring_is_stiffest_where_the_line_of_action_leaves_through_a_pin) {
  annulus::test::Verification record("Where a ring on six pins is stiffest",
                                     "geometry: where the line of action leaves the rim through a pin");
  const double pin = 0.2;
  const auto problem = ring_mesh(paper_pins(6, pin), 2);
  const auto result = solve_plane(problem);
  int best = 0;
  for (int i = 0; i < result.table.positions(); ++i)
    if (result.table.at(i, 0, 0).lte < result.table.at(best, 0, 0).lte) best = i;
  // From the pitch point outwards and clockwise along the line of action to the outside: length t, polar angle back.
  const double alpha = problem.pair.working_pressure_angle();
  const double r = problem.pair.wheel().base_radius() / std::cos(alpha);
  const double t =
      -r * std::sin(alpha) + std::sqrt(std::pow(r * std::sin(alpha), 2) + ring_outside * ring_outside - r * r);
  const double back = std::atan2(t * std::cos(alpha), r + t * std::sin(alpha));
  const double spacing = 2 * M_PI / 6;
  const double off = std::remainder(result.table.ring_angles()[best] - back - pin, spacing);
  BOOST_TEST_MESSAGE("stiffest " << off << " rad from where the line of action meets a pin");
  // Positions are a tooth pitch apart (0.039 rad), the load is spread over two teeth; half the spacing is 0.52 rad.
  record.near("angle from there to the stiffest position", "rad", off, 0, 1.5 * problem.pair.wheel().pitch_angle(),
              "positions are a tooth pitch apart, the load is spread over two teeth");
  annulus::test::RecordedPlot::Curve curve{"", {}, {}, {}};
  annulus::test::RecordedPlot::Curve pins{"pin on the line of action", {}, {}, {}};
  curve.label = "transmission error";
  double low = 1e9, high = 0;
  for (int i = 0; i < result.table.positions(); ++i) {
    curve.x.push_back(result.table.ring_angles()[i] * 180 / M_PI);
    curve.computed.push_back(result.table.at(i, 0, 0).lte * 1e6);
    low = std::min(low, curve.computed.back()), high = std::max(high, curve.computed.back());
  }
  const double first = curve.x.front() * M_PI / 180;
  const double place = first + std::remainder(back + pin - first - spacing / 2, spacing) + spacing / 2;
  pins.x = {place * 180 / M_PI, place * 180 / M_PI};
  pins.computed = {low, high};
  record.plot({"Loaded transmission error of a ring on six pins",
               "place of the contact on the ring, deg",
               "um",
               {curve, pins}});
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_nothing_at_all) {
  annulus::test::Verification record("A ring on 24 pins that may lift off, on two threads", "the same on one thread");
  const auto one = solve_plane(ring_mesh(paper_pins(24, first_pin), 2), 1, 1);
  check_identical(pinned(), one);
  record.at_most("transmission error, largest relative difference", "", largest_lte_difference(pinned(), one), 0,
                 "equal to the last bit");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(bolted_ring)

using namespace annulus::tests;

BOOST_AUTO_TEST_CASE(lift_off_only_ever_softens) {
  annulus::test::Verification record("Pins that lift off against bolts",
                                     "least work: a ring that may leave its supports gives way no less");
  auto pins = paper_pins(24, 0);
  const auto loose = solve_plane(ring_mesh(pins, 2));
  pins.unilateral = false;
  const auto bolted = solve_plane(ring_mesh(pins, 2));
  check_invariants(bolted);
  for (std::size_t i = 0; i < loose.positions.size(); ++i)
    record.at_least("transmission error on pins over that on bolts", "",
                    loose.positions[i].entry.lte / bolted.positions[i].entry.lte, 1, "least work");
  BOOST_TEST(largest_lte_difference(loose, bolted) > 1e-3);
}

BOOST_AUTO_TEST_CASE(pins_that_do_not_lift_are_bolts) {
  annulus::test::Verification record("Pins pressed in so far that none lifts off", "bolts: the same equations");
  auto pins = paper_pins(24, 0);
  pins.clearance = -50e-6;  // pressed in: all touch
  const auto pressed = solve_plane(ring_mesh(pins, 2));
  for (const auto& p : pressed.positions)
    for (const auto& pin : p.pins) BOOST_TEST_REQUIRE(pin.touching);
  pins.unilateral = false;
  const auto bolted = solve_plane(ring_mesh(pins, 2));
  record.at_most("transmission error, largest relative difference", "", largest_lte_difference(pressed, bolted), 1e-9,
                 "rounding");
}

BOOST_AUTO_TEST_CASE(many_stiff_bolts_hold_the_outside) {
  annulus::test::Verification record("162 stiff bolts, side by side", "limit: the held outside");
  auto bolts = paper_pins(162, 0);
  bolts.unilateral = false;
  bolts.pin_diameter = 12.8e-3;  // nearly all of the pitch of 12.87 mm
  bolts.radial_stiffness = 1e14;
  const auto bolted = solve_plane(ring_mesh(bolts, 4)), held = solve_plane(ring_mesh(annulus::fem::OutsideHeld{}, 4));
  for (std::size_t i = 0; i < held.positions.size(); ++i) {
    const double ratio = bolted.positions[i].entry.lte / held.positions[i].entry.lte;
    BOOST_TEST_MESSAGE("bolted / held - 1 = " << ratio - 1);
    record.at_least("transmission error over that of the held ring", "", ratio, 1, "bolts hold less");
    // A bolt holds a weighted mean over a tooth pitch: what it leaves free fades over a pitch / 2 pi = 2 mm of the
    // rim's depth of 18 mm, and carries a small part of the deflection.
    record.at_most("transmission error over that of the held ring", "", ratio, 1.01,
                   "what a bolt leaves free fades over 2 mm of a rim of 18 mm");
  }
}

BOOST_AUTO_TEST_SUITE_END()
