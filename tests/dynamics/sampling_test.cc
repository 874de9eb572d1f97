#include "dynamics/statistics/sampling.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "core/errors.h"

namespace annulus::dynamics {

BOOST_AUTO_TEST_SUITE(sampling)

BOOST_AUTO_TEST_CASE(draws_depend_on_their_arguments_alone) {
  std::set<double> seen;
  for (std::uint64_t seed : {1, 2}) {
    for (std::uint64_t sample = 0; sample < 50; ++sample) {
      for (const auto* name : {"a", "b", "errors.planet_eccentricity_phase_deg[1]"}) {
        const double u = uniform_draw(seed, sample, name);
        BOOST_TEST((u > 0 && u < 1));
        BOOST_TEST(uniform_draw(seed, sample, name) == u);
        seen.insert(u);
      }
    }
  }
  BOOST_TEST(seen.size() == 300U);  // no two the same
  // The same on every platform and in every version: values of another implementation of FNV-1a, std::seed_seq and
  // MT19937-64 after their definitions.
  BOOST_TEST(uniform_draw(1, 0, "a") == 0.6805532079971579);
  BOOST_TEST(uniform_draw(std::uint64_t{1} << 40, 3, "errors.planet_eccentricity_phase_deg[1]") == 0.9147714108029779);
  BOOST_TEST(uniform_draw(std::uint64_t{1} << 40, 0, "a") != uniform_draw(0, 0, "a"));
}

BOOST_AUTO_TEST_CASE(draws_are_uniform_and_uncorrelated) {
  constexpr int n = 20000;
  std::vector<double> a, b;
  for (int i = 0; i < n; ++i) {
    a.push_back(uniform_draw(3, static_cast<std::uint64_t>(i), "a"));
    b.push_back(uniform_draw(3, static_cast<std::uint64_t>(i), "b"));
  }
  double correlation = 0, serial = 0;
  for (int i = 0; i < n; ++i) {
    correlation += 12 * (a[i] - 0.5) * (b[i] - 0.5) / n;
    serial += 12 * (a[i] - 0.5) * (a[(i + 1) % n] - 0.5) / n;
  }
  // Both have the standard deviation 1/sqrt(n): four of them.
  BOOST_TEST(std::abs(correlation) < 4 / std::sqrt(n));
  BOOST_TEST(std::abs(serial) < 4 / std::sqrt(n));
  // Kolmogorov's distance stays below 1.95/sqrt(n) with probability 0.999.
  std::sort(a.begin(), a.end());
  double distance = 0;
  for (int i = 0; i < n; ++i) distance = std::max(distance, std::abs(a[i] - (i + 0.5) / n));
  BOOST_TEST(distance < 1.95 / std::sqrt(n));
}

/// Mean and standard deviation by the midpoint rule over the probabilities.
std::pair<double, double> moments(const Distribution& d) {
  constexpr int n = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double x = d.quantile((i + 0.5) / n);
    sum += x;
    squares += x * x;
  }
  return {sum / n, std::sqrt(squares / n - sum / n * (sum / n))};
}

BOOST_AUTO_TEST_CASE(distributions_have_their_moments) {
  using Kind = Distribution::Kind;
  const auto close = boost::test_tools::tolerance(1e-3);  // the midpoint rule cuts the tails
  const auto uniform = moments({.kind = Kind::uniform, .low = 2, .high = 8});
  BOOST_TEST(uniform.first == 5.0, close);
  BOOST_TEST(uniform.second == 6 / std::sqrt(12.0), close);
  const auto normal = moments({.kind = Kind::normal, .mean = -3, .deviation = 2});
  BOOST_TEST(normal.first == -3.0, close);
  BOOST_TEST(normal.second == 2.0, close);
  const auto lognormal = moments({.kind = Kind::lognormal, .mean = 1e7, .deviation = 3e6});
  BOOST_TEST(lognormal.first == 1e7, close);
  BOOST_TEST(lognormal.second == 3e6, close);
  // Half a normal distribution: mean sqrt(2/pi), variance 1 - 2/pi; both halves, far out as well.
  const auto half = moments({.kind = Kind::normal, .mean = 0, .deviation = 1, .low = 0});
  BOOST_TEST(half.first == std::sqrt(2 / M_PI), close);
  BOOST_TEST(half.second == std::sqrt(1 - 2 / M_PI), close);
  // Truncated normal: mean = (phi(a) - phi(b)) / (Phi(b) - Phi(a)).
  const boost::math::normal law;
  const double a = 2, b = 3;
  const auto tail = moments({.kind = Kind::normal, .mean = 0, .deviation = 1, .low = a, .high = b});
  BOOST_TEST(tail.first == (pdf(law, a) - pdf(law, b)) / (cdf(law, b) - cdf(law, a)), close);
}

BOOST_AUTO_TEST_CASE(rayleigh_has_its_moments_and_truncation) {
  using Kind = Distribution::Kind;
  const auto close = boost::test_tools::tolerance(1e-3);  // the midpoint rule cuts the tails
  const auto whole = moments({.kind = Kind::rayleigh, .scale = 3});
  BOOST_TEST(whole.first == 3 * std::sqrt(M_PI / 2), close);
  BOOST_TEST(whole.second == 3 * std::sqrt(2 - M_PI / 2), close);
  // r^2 of a Rayleigh amplitude is exponential and has no memory: beyond 4 it is 16 more than from 0.
  const Distribution free{.kind = Kind::rayleigh, .scale = 3}, tail{.kind = Kind::rayleigh, .low = 4, .scale = 3};
  for (const double p : {0.01, 0.5, 0.99})
    BOOST_TEST(tail.quantile(p) == std::hypot(4, free.quantile(p)), boost::test_tools::tolerance(1e-12));
  BOOST_CHECK_NO_THROW(tail.check());
  BOOST_CHECK_THROW((Distribution{.kind = Kind::rayleigh}.check()), InputError);
  BOOST_CHECK_THROW((Distribution{.kind = Kind::rayleigh, .high = -1, .scale = 3}.check()), InputError);
}

BOOST_AUTO_TEST_CASE(counter_draws_are_uniform_and_independent) {
  constexpr int n = 10000;
  const CounterDraws a(3, "a"), b(3, "b"), other_seed(4, "a");
  std::vector<double> values;
  double names = 0, seeds = 0, serial = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    values.push_back(a(i));
    names += 12 * (a(i) - 0.5) * (b(i) - 0.5) / n;
    seeds += 12 * (a(i) - 0.5) * (other_seed(i) - 0.5) / n;
    serial += 12 * (a(i) - 0.5) * (a(i + 1) - 0.5) / n;
  }
  // All have the standard deviation 1/sqrt(n): four of them.
  for (const double correlation : {names, seeds, serial}) BOOST_TEST(std::abs(correlation) < 4 / std::sqrt(n));
  std::sort(values.begin(), values.end());
  double distance = 0;
  for (int i = 0; i < n; ++i) distance = std::max(distance, std::abs(values[i] - (i + 0.5) / n));
  BOOST_TEST(distance < 1.95 / std::sqrt(n));  // Kolmogorov, 0.999
}

BOOST_AUTO_TEST_CASE(impossible_distributions_are_refused) {
  using Kind = Distribution::Kind;
  const auto refused = [](const Distribution& d) { BOOST_CHECK_THROW(d.check(), InputError); };
  refused({.kind = Kind::uniform});
  refused({.kind = Kind::uniform, .low = 2, .high = 2});
  refused({.kind = Kind::normal, .mean = 1, .deviation = 0});
  refused({.kind = Kind::normal, .mean = 0, .deviation = 1, .low = 5});
  refused({.kind = Kind::lognormal, .mean = -1, .deviation = 1});
  refused({.kind = Kind::lognormal, .mean = 1, .deviation = 1, .high = -1});
  BOOST_CHECK_NO_THROW((Distribution{.kind = Kind::normal, .mean = 0, .deviation = 1, .low = 2}.check()));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::dynamics
