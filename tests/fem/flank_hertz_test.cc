#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "fem/contact/hertz.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Line contact of condensed gears against Hertz: the mesh knows nothing of the contact's size.
BOOST_AUTO_TEST_SUITE(flank_hertz)

using namespace annulus::tests;
using annulus::fem::LoadedPosition;

/// Pressure of one tooth pair against that of Hertz for the load that the pair carries: relative differences.
struct Difference {
  double peak = 0, half_width = 0, centre = 0;  ///< centre: in half-widths
};

Difference from_hertz(const ContactBench& bench, const LoadedPosition& position, int pair) {
  const double base = bench.flanks().pair().pinion().base_radius(), roll = position.pair_roll[pair];
  const auto arc = [&](double r) { return r * r / (2 * base); };
  const double line_load = position.pair_share[pair] * position.load / bench.face_width();
  const double b = annulus::fem::hertz_half_width(line_load, bench.flanks().pair().relative_curvature(roll), {});
  double peak = 0, force = 0, first = 0, second = 0;
  for (const auto& patch : position.pressure) {
    if (patch.pair != pair) continue;
    peak = std::max(peak, patch.pressure);
    const double length = arc(patch.roll_high) - arc(patch.roll_low);
    const double x = (arc(patch.roll_high) + arc(patch.roll_low)) / 2 - arc(roll), f = patch.pressure * length;
    force += f;
    first += f * x;
    second += f * (x * x + length * length / 12);
  }
  // The pressures are all of the load.
  BOOST_TEST(force == line_load, boost::test_tools::tolerance(1e-9));
  Difference d;
  d.peak = peak / (2 * line_load / (M_PI * b)) - 1;
  d.half_width = 2 * std::sqrt(second / force - std::pow(first / force, 2)) / b - 1;  // a semi-ellipse: b^2 / 4
  d.centre = first / force / b;
  return d;
}

// Constant pressure on n elements in the half-width is wrong by some (1/n)^2 / 2: with 7, 9, 11 and 14 of them at
// levels 0 to 3, 1 % to 0.25 %. Against it the finite teeth (the half-plane is as long as the flank: (b / 6 mm)^2 / 2 =
// 0.2 % at the nominal load, b = 0.4 mm) hardly count.
constexpr double tolerance = 0.01;
// The slope of the surfaces' own deflection moves the centre by it over the relative curvature; half a per cent of b
// where the flank bends little, more where the pair stands near its tip.
constexpr double centre_tolerance = 0.03;

BOOST_AUTO_TEST_CASE(a_single_pair_presses_as_hertz_says_at_any_load_and_on_any_mesh) {
  annulus::test::Verification record("Pressure of a single tooth pair, four meshes, a thousandth to the nominal load",
                                     "Hertz for the load of the pair and the curvatures of the involutes");
  // Mid-flank positions of the only pair in contact. The ring's rim is soft: at its nominal load there are always two.
  for (const bool internal : {true, false})
    for (const int level : {0, 1, 2, 3}) {
      ContactBench bench(internal ? ring_mesh(annulus::fem::OutsideHeld{}, 2) : sun_mesh(2), level);
      const double phase = internal ? 0.86 : 0.03, heaviest = internal ? 0.1 : 1;
      for (const double load : {1e-3, 1e-2, 0.1, 1.0}) {
        if (load > heaviest) continue;
        const LoadedPosition position = bench.solve(phase, load * nominal_load);
        const auto pair = std::max_element(position.pair_share.begin(), position.pair_share.end());
        BOOST_TEST_REQUIRE(std::abs(*pair - 1) < 1e-9);
        const auto d = from_hertz(bench, position, static_cast<int>(pair - position.pair_share.begin()));
        BOOST_TEST_MESSAGE((internal ? "ring" : "sun") << " level " << level << " load " << load << ": peak " << d.peak
                                                       << ", half-width " << d.half_width << ", centre " << d.centre);
        const char* origin = "7 to 14 pressure elements in the half-width: (1/n)^2 / 2; finite teeth";
        record.near("peak pressure over Hertz", "", 1 + d.peak, 1, tolerance, origin);
        record.near("half-width over Hertz", "", 1 + d.half_width, 1, tolerance, origin);
        record.near("centre of the contact by half-widths", "", d.centre, 0, centre_tolerance,
                    "teeth bend and shift the contact along the flank");
        BOOST_TEST(!position.tip_edge_contact);
      }
    }
}

BOOST_AUTO_TEST_CASE(every_pair_that_stays_away_from_tip_edges_does) {
  annulus::test::Verification record("Pressure of every tooth pair away from tip edges, nominal load",
                                     "Hertz for the load of the pair and the curvatures of the involutes");
  // Pairs that share the load have windows as long as the whole load needs, fewer elements in their own contact.
  for (const bool internal : {true, false}) {
    const auto problem = internal ? ring_mesh(annulus::fem::OutsideHeld{}, 2) : sun_mesh(2);
    ContactBench bench(problem, 1);
    const auto& pair = problem.pair;
    const double base = pair.pinion().base_radius();
    int compared = 0;
    Difference worst;
    for (const auto& position : bench.sweep(16, nominal_load))
      for (int p = 0; p < static_cast<int>(position.pair_share.size()); ++p) {
        const double share = position.pair_share[p], roll = position.pair_roll[p];
        if (share < 0.2) continue;
        const double b = annulus::fem::hertz_half_width(share * nominal_load / bench.face_width(),
                                                        bench.flanks().pair().relative_curvature(roll), {});
        const double low = (std::pow(roll, 2) - std::pow(pair.roll_length_low(), 2)) / (2 * base);
        const double high = (std::pow(pair.roll_length_high(), 2) - std::pow(roll, 2)) / (2 * base);
        if (std::min(low, high) < 3 * b) continue;  // nearer, the edge lets the pressure rise
        const auto d = from_hertz(bench, position, p);
        worst.peak = std::max(worst.peak, std::abs(d.peak));
        worst.half_width = std::max(worst.half_width, std::abs(d.half_width));
        ++compared;
      }
    BOOST_TEST_MESSAGE(compared << " pairs: worst peak " << worst.peak << ", half-width " << worst.half_width);
    BOOST_TEST(compared >= 8);
    // Four elements at least in a half-width at a fifth of the load: (1/4)^2 / 2 = 3 %.
    const char* origin = "four pressure elements in the half-width: (1/4)^2 / 2";
    record.at_most("peak pressure, difference from Hertz", "", worst.peak, 0.03, origin);
    record.at_most("half-width, difference from Hertz", "", worst.half_width, 0.03, origin);
  }
}

BOOST_AUTO_TEST_SUITE_END()
