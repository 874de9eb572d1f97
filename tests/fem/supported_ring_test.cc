#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "fem/loaded_mesh.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Rings on pins of their own stiffness and place, in a housing bore, and splined.
BOOST_AUTO_TEST_SUITE(supported_ring)

using namespace annulus::tests;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshResult;
using annulus::fem::LoadedPosition;
using annulus::fem::PinState;

/// Sum of the forces on pins and housing, in the frame of the real ring: x, y, and the moment over the outside radius.
Eigen::Vector3d support_resultant(const LoadedMeshResult& result, const LoadedPosition& p) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto add = [&](const PinState& state, double angle) {
    const Eigen::Vector2d radial(std::cos(angle), std::sin(angle)), tangential(-radial.y(), radial.x());
    sum.head<2>() += state.radial_force * radial + state.tangential_force * tangential;
    sum[2] += state.tangential_force;
  };
  for (std::size_t i = 0; i < p.pins.size(); ++i) add(p.pins[i], result.pin_angles[i]);
  for (std::size_t i = 0; i < p.housing.size(); ++i)
    add(p.housing[i], 2 * M_PI * static_cast<double>(i) / static_cast<double>(p.housing.size()));
  return sum;
}

/// The supports carry what the planet presses on the ring: its force along the line of action, its torque.
/// `lever_loss`: the lever arm of supports over +- beta is R (1 - c beta^2), c = 1/10 for a parabola, 1/6 for an even
/// pressure.
void check_equilibrium(annulus::test::Verification& record, const LoadedMeshProblem& problem,
                       const LoadedMeshResult& result, double lever_loss) {
  const double alpha = problem.pair.working_pressure_angle();
  double worst_force = 0, worst_moment = 0;  // the former per metre of transmission error
  for (const auto& p : result.positions) {
    const Eigen::Vector3d sum = support_resultant(result, p);
    const double c = std::cos(p.ring_angle), s = std::sin(p.ring_angle);
    // Seen from the carrier the planet turns clockwise: at the pitch point it presses the ring outwards and clockwise.
    const Eigen::Vector2d expected =
        p.load * Eigen::Vector2d(c * std::sin(alpha) + s * std::cos(alpha), s * std::sin(alpha) - c * std::cos(alpha));
    worst_force = std::max(worst_force, (sum.head<2>() - expected).norm() / p.load / p.entry.lte);
    const double torque = p.load * problem.pair.wheel().base_radius();
    worst_moment = std::max(worst_moment, std::abs(sum[2] * ring_outside * (1 - lever_loss) / torque + 1));
  }
  BOOST_TEST_MESSAGE("worst force " << worst_force << ", moment " << worst_moment);
  // Contacts shift along the flanks and turn the direction of the resultant by up to 3e-3 rad for 40 um (see the pinned
  // ring); the lever arms are series of the half arc cut off at its fourth power.
  record.at_most("force on the supports, relative error per um of transmission error", "", worst_force * 1e-6,
                 3e-3 / 40, "contacts shift along the flanks and turn the resultant by 3e-3 rad for 40 um");
  record.at_most("torque of the supports, relative error", "", worst_moment, 1e-5,
                 "lever arms: series of the half arc cut off at its fourth power");
}

BOOST_AUTO_TEST_CASE(a_ring_on_soft_pins_moves_like_a_rigid_body_on_springs) {
  annulus::test::Verification record("A ring on soft bolts",
                                     "closed form: a rigid body on springs, F (1/k_translation + r_b^2/k_rotation)");
  auto pins = paper_pins(24, 0.01);
  pins.unilateral = false;
  const double rb = ring_mesh(pins, 2).pair.wheel().base_radius(), half_arc = pin_diameter / 2 / ring_outside;
  const double lever = ring_outside * (1 - half_arc * half_arc / 10);
  const double load = nominal_load / 100;  // flanks that face each other beyond the path of contact stay apart
  for (const auto& [radial, tangential] : {std::pair{3e3, 1e3}, {1e3, 3e3}}) {
    pins.radial_stiffness = radial;
    pins.tangential_stiffness = tangential;
    const auto result = solve_plane(ring_mesh(pins, 2, {load}));
    check_invariants(result);
    BOOST_TEST(result.pin_stiffness == radial, boost::test_tools::tolerance(1e-14));
    const double translation = 24 / 2.0 * (radial + tangential), rotation = 24 * tangential * lever * lever;
    const double rigid = load * (1 / translation + rb * rb / rotation);
    double worst = 0;
    for (const auto& p : result.positions) worst = std::max(worst, std::abs(p.entry.lte / rigid - 1));
    BOOST_TEST_MESSAGE("rigid motion of " << rigid << " m off by " << worst);
    // What is left is the bending of the rim between supports that press all around, about a millimetre.
    record.at_most("transmission error, largest relative difference", "", worst, 5e-3,
                   "bending of the rim between its supports");
  }
}

BOOST_AUTO_TEST_CASE(pins_with_a_free_span_are_softer_pins) {
  annulus::test::Verification record("Pins with a free span", "pins of the same total stiffness: the same equations");
  auto pins = paper_pins(18, 0.01);
  const auto tight = solve_plane(ring_mesh(pins, 2));
  pins.free_span = 8e-3;
  const auto spanned = solve_plane(ring_mesh(pins, 2));
  BOOST_TEST(spanned.pin_stiffness < tight.pin_stiffness);
  for (std::size_t i = 0; i < tight.positions.size(); ++i)
    BOOST_TEST(spanned.positions[i].entry.lte > tight.positions[i].entry.lte);
  pins.free_span = 0;
  pins.radial_stiffness = spanned.pin_stiffness;
  const auto given = solve_plane(ring_mesh(pins, 2));
  record.at_most("transmission error, largest relative difference", "", largest_lte_difference(given, spanned), 1e-9,
                 "rounding");
}

BOOST_AUTO_TEST_CASE(one_pin_turns_the_ring_and_the_housing_holds_it) {
  annulus::test::Verification record("A ring on one pin in the bore of its housing",
                                     "statics: supports balance the planet");
  auto pin = paper_pins(1, 0.4);
  pin.housing_clearance = 20e-6;
  const auto problem = ring_mesh(pin, 2);
  const auto result = solve_plane(problem);
  BOOST_TEST(result.table.positions() == 162);
  BOOST_TEST_REQUIRE(result.positions.front().housing.size() == 162U);
  check_invariants(result);
  const double half_arc = pin_diameter / 2 / ring_outside;
  check_equilibrium(record, problem, result, half_arc * half_arc / 10);
  std::size_t most = 0, least = 162;
  for (const auto& p : result.positions) {
    BOOST_TEST_REQUIRE(p.pins.size() == 1U);
    std::size_t touching = 0;
    for (const auto& patch : p.housing) {
      BOOST_TEST(patch.radial_force >= 0);
      BOOST_TEST(patch.tangential_force == 0);
      touching += patch.touching;
    }
    most = std::max(most, touching);
    least = std::min(least, touching);
  }
  BOOST_TEST_MESSAGE("patches touching: " << least << " to " << most);
  BOOST_TEST(least > 0U);
  BOOST_TEST(most < 162U);
}

BOOST_AUTO_TEST_CASE(a_tight_housing_only_ever_stiffens_a_pinned_ring) {
  annulus::test::Verification record(
      "A pinned ring in its housing",
      "least work: a further support never softens; one that is never reached changes nothing");
  auto pins = paper_pins(6, 0.2);
  const auto free = solve_plane(ring_mesh(pins, 2));
  pins.housing_clearance = 0;
  const auto held = solve_plane(ring_mesh(pins, 2));
  pins.housing_clearance = 1;  // never reached
  const auto loose = solve_plane(ring_mesh(pins, 2));
  check_invariants(held);
  for (std::size_t i = 0; i < free.positions.size(); ++i)
    record.at_most("transmission error in a tight housing over that without", "",
                   held.positions[i].entry.lte / free.positions[i].entry.lte, std::nextafter(1.0, 0.0), "least work");
  record.at_most("transmission error in a housing that is never reached, relative difference", "",
                 largest_lte_difference(free, loose), 1e-9, "rounding");
}

BOOST_AUTO_TEST_CASE(pins_at_given_angles_have_no_order_and_no_spacing) {
  annulus::test::Verification record("A ring on five pins at unequal angles",
                                     "statics: supports balance the planet; the order of the pins does not matter");
  auto pins = paper_pins(5, 0);
  pins.angles = {0.1, 1.2, 2.9, 4.0, 5.5};
  const auto problem = ring_mesh(pins, 2);
  const auto result = solve_plane(problem);
  BOOST_TEST(result.table.positions() == 162);
  check_invariants(result);
  const double half_arc = pin_diameter / 2 / ring_outside;
  check_equilibrium(record, problem, result, half_arc * half_arc / 10);
  pins.angles = {4.0, 0.1 + 2 * M_PI, 5.5, 1.2, 2.9};
  const auto shuffled = solve_plane(ring_mesh(pins, 2));
  record.at_most("pins in another order: transmission error, largest relative difference", "",
                 largest_lte_difference(result, shuffled), 1e-9, "rounding");
  for (std::size_t i = 0; i < result.positions.size(); ++i)
    BOOST_TEST(std::abs(shuffled.positions[i].pins[0].radial_force - result.positions[i].pins[3].radial_force) <
               1e-7 * nominal_load);
}

BOOST_AUTO_TEST_CASE(a_spline_with_play_carries_on_the_flanks_that_resist) {
  annulus::test::Verification record("A ring in a spline with play", "statics: supports balance the planet");
  annulus::fem::SplineHeld spline;
  spline.teeth = 54;
  spline.flank_angle = 30 * M_PI / 180;
  spline.clearance = 5e-6;
  const auto problem = ring_mesh(spline, 2);
  const auto result = solve_plane(problem);
  BOOST_TEST(result.table.positions() == 3);  // 162 / 54
  check_invariants(result);
  const double half_arc = 2 * M_PI / 54 / 4;
  check_equilibrium(record, problem, result, half_arc * half_arc / 6);
  for (const auto& p : result.positions) {
    int touching = 0;
    for (const auto& tooth : p.pins) {
      touching += tooth.touching;
      // Either flank presses inwards on the ring.
      BOOST_TEST(tooth.radial_force >= 0);
      BOOST_TEST(std::abs(tooth.tangential_force) <= tooth.radial_force / std::tan(spline.flank_angle) * (1 + 1e-12));
    }
    BOOST_TEST(touching > 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
