#include "dynamics/time_integration/contact_margins.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

BOOST_AUTO_TEST_SUITE(contact_margins)

using annulus::dynamics::first_descent;

/// The cubic with these values and slopes at 0 and 1.
double cubic(double begin, double begin_slope, double end, double end_slope, double x) {
  const double a = 2 * (begin - end) + begin_slope + end_slope, b = 3 * (end - begin) - 2 * begin_slope - end_slope;
  return begin + x * (begin_slope + x * (b + x * a));
}

BOOST_AUTO_TEST_CASE(descents_are_those_of_a_scan) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(0, 1), slope(-8, 8), end(-1, 1);
  int found = 0, between = 0;
  for (int n = 0; n < 2000; ++n) {
    const double a = value(random), as = slope(random), b = end(random), bs = slope(random);
    constexpr int steps = 20000;
    int first = 0;
    while (first <= steps && cubic(a, as, b, bs, static_cast<double>(first) / steps) >= 0) ++first;
    const auto where = first_descent(a, as, b, bs);
    if (first > steps) {
      // A dip between two places of the scan is no deeper than the curve bends there.
      if (where) BOOST_TEST(std::abs(cubic(a, as, b, bs, *where)) < 1e-6);
      continue;
    }
    ++found;
    between += b > 0 ? 1 : 0;
    BOOST_TEST_REQUIRE(where.has_value());
    BOOST_TEST(*where <= static_cast<double>(first) / steps);
    BOOST_TEST(std::abs(*where - static_cast<double>(first) / steps) < 1.5 / steps);
  }
  BOOST_TEST(found > 500);
  BOOST_TEST(between > 50);  // dips that end above zero
}

BOOST_AUTO_TEST_CASE(ends_of_a_step) {
  BOOST_TEST(!first_descent(1, 0, 1, 0).has_value());
  BOOST_TEST(!first_descent(0, 1, 2, 0).has_value());  // rises from zero
  BOOST_TEST(*first_descent(-1e-9, 0, 1, 0) == 0);     // below zero at once
  BOOST_TEST(*first_descent(1, -2, -1, -2) == 0.5, boost::test_tools::tolerance(1e-9));
  const double infinite = std::numeric_limits<double>::infinity();
  BOOST_TEST(!first_descent(infinite, 0, infinite, 0).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
