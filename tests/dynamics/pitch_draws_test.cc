#include "dynamics/statistics/pitch_draws.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

using annulus::dynamics::drawn_pitch_deviations;

BOOST_AUTO_TEST_SUITE(pitch_draws)

namespace {

double largest(const std::vector<double>& pitch) {
  double most = 0;
  for (const double p : pitch) most = std::max(most, std::abs(p));
  return most;
}

/// Range of the cumulative deviation.
double total(const std::vector<double>& pitch) {
  std::vector<double> sums(pitch.size());
  std::partial_sum(pitch.begin(), pitch.end(), sums.begin());
  const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
  return *high - *low;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_drawn_gear_uses_both_tolerances_up) {
  for (const int teeth : {24, 55, 162})
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const auto pitch = drawn_pitch_deviations({teeth, 7e-6, 21e-6}, seed, "sun");
      BOOST_TEST(pitch.size() == static_cast<std::size_t>(teeth));
      BOOST_TEST(std::abs(std::accumulate(pitch.begin(), pitch.end(), 0.0)) < 1e-18 * teeth);
      BOOST_TEST(largest(pitch) == 7e-6, boost::test_tools::tolerance(1e-9));
      BOOST_TEST(total(pitch) == 21e-6, boost::test_tools::tolerance(1e-9));
    }
}

// The wave of eight teeth alone has steps of 2 sin(pi / 8) half its range; wide single tolerances are not reached.
BOOST_AUTO_TEST_CASE(one_tolerance_is_kept_where_both_cannot_be_reached) {
  const auto few = drawn_pitch_deviations({8, 4e-6, 20e-6}, 1, "sun");
  BOOST_TEST(largest(few) == 4e-6, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(total(few) < 20e-6);
  const auto wide = drawn_pitch_deviations({30, 50e-6, 20e-6}, 1, "sun");
  BOOST_TEST(total(wide) == 20e-6, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(largest(wide) < 50e-6);
}

BOOST_AUTO_TEST_CASE(seeds_and_names_are_other_gears) {
  const auto one = drawn_pitch_deviations({24, 7e-6, 21e-6}, 1, "planet 1");
  BOOST_TEST(one == drawn_pitch_deviations({24, 7e-6, 21e-6}, 1, "planet 1"), boost::test_tools::per_element());
  BOOST_TEST((one != drawn_pitch_deviations({24, 7e-6, 21e-6}, 2, "planet 1")));
  BOOST_TEST((one != drawn_pitch_deviations({24, 7e-6, 21e-6}, 1, "planet 2")));
}

BOOST_AUTO_TEST_SUITE_END()
