#include "dynamics/statistics/statistics.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "dynamics/statistics/sampling.h"

namespace annulus::dynamics {

BOOST_AUTO_TEST_SUITE(statistics)

BOOST_AUTO_TEST_CASE(mean_with_students_interval) {
  const std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const auto mean = mean_interval(values);
  BOOST_TEST(mean.value == 5.5);
  BOOST_TEST(standard_deviation(values) == std::sqrt(55.0 / 6), boost::test_tools::tolerance(1e-14));
  // t(0.975, 9) = 2.2622 (table of any textbook)
  BOOST_TEST(mean.high - 5.5 == 2.2622 * std::sqrt(55.0 / 6 / 10), boost::test_tools::tolerance(2e-5));
  BOOST_TEST(mean.high + mean.low == 11.0, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(std::isinf(mean_interval({3}).high));
  BOOST_TEST(std::isnan(standard_deviation({3})));
  BOOST_CHECK_THROW((void)mean_interval({}), InputError);
}

BOOST_AUTO_TEST_CASE(quantiles_between_order_statistics) {
  std::vector<double> values(100);
  std::iota(values.rbegin(), values.rend(), 1.0);  // in falling order: sorting is part of the job
  const auto median = quantile_interval(values, 0.5);
  BOOST_TEST(median.value == 50.5);
  // The classical ranks for the median of 100 values at 95 %: 40 and 61 (Conover, Practical Nonparametric Statistics).
  BOOST_TEST(median.low == 40.0);
  BOOST_TEST(median.high == 61.0);
  // P(no value below the 5 % quantile) = 0.95^100 = 0.0059 <= 0.025 < P(at most one): the lowest value is the end.
  BOOST_TEST(quantile_interval(values, 0.05).low == 1.0);
  // With 60 values 0.95^60 = 0.046 > 0.025: no lower end.
  values.resize(60);
  BOOST_TEST(quantile_interval(values, 0.05).low == -std::numeric_limits<double>::infinity());
  BOOST_TEST(quantile_interval({7}, 0.95).value == 7.0);
  BOOST_CHECK_THROW((void)quantile_interval({}, 0.5), InputError);
  BOOST_CHECK_THROW((void)quantile_interval({1}, 1.0), InputError);
}

BOOST_AUTO_TEST_CASE(shares_after_clopper_and_pearson) {
  const auto none = share_interval(0, 10);
  BOOST_TEST(none.low == 0.0);
  BOOST_TEST(none.high == 1 - std::pow(0.025, 0.1), boost::test_tools::tolerance(1e-12));
  const auto all = share_interval(10, 10);
  BOOST_TEST(all.low == std::pow(0.025, 0.1), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(all.high == 1.0);
  const auto half = share_interval(5, 10);  // published: 0.1871 to 0.8129
  BOOST_TEST(std::abs(half.low - 0.1871) < 5e-5);
  BOOST_TEST(std::abs(half.high - 0.8129) < 5e-5);
  BOOST_CHECK_THROW((void)share_interval(3, 2), InputError);
  BOOST_CHECK_THROW((void)share_interval(0, 0), InputError);
}

/// How many of 2000 repetitions with 40 values each have an interval that holds the truth.
template <class Make>
double coverage(const Distribution& law, double truth, Make interval) {
  int held = 0;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    std::vector<double> values;
    for (int i = 0; i < 40; ++i)
      values.push_back(law.quantile(uniform_draw(11, static_cast<std::uint64_t>(repeat * 40 + i), "coverage")));
    const Interval found = interval(values);
    held += found.low <= truth && truth <= found.high ? 1 : 0;
  }
  return held / 2000.0;
}

BOOST_AUTO_TEST_CASE(intervals_hold_the_truth_as_often_as_they_say) {
  constexpr double slack = 4 * 0.0049;  // four standard deviations of a share of 0.95 in 2000 repetitions
  const Distribution normal{.kind = Distribution::Kind::normal, .mean = 3, .deviation = 2};
  const double mean = coverage(normal, 3, [](const auto& v) { return mean_interval(v); });
  BOOST_TEST(std::abs(mean - 0.95) < slack);
  // Distribution-free intervals hold at least what they promise, for a skewed law as well; the exact coverage for the
  // median of 40 is 0.9615 (ranks 14 and 27).
  const Distribution skewed{.kind = Distribution::Kind::lognormal, .mean = 1, .deviation = 2};
  const double truth = skewed.quantile(0.5);
  const double median = coverage(skewed, truth, [](const auto& v) { return quantile_interval(v, 0.5); });
  BOOST_TEST(std::abs(median - 0.9615) < slack);
  const double upper = skewed.quantile(0.8);
  BOOST_TEST(coverage(skewed, upper, [](const auto& v) { return quantile_interval(v, 0.8); }) > 0.95 - slack);
  const double share = coverage({.low = 0, .high = 1}, 0.3, [](const auto& v) {
    return share_interval(std::count_if(v.begin(), v.end(), [](double x) { return x < 0.3; }), 40);
  });
  BOOST_TEST(share > 0.95 - slack);
  BOOST_TEST(share < 1.0);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::dynamics
