#include "dynamics/statistics/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/errors.h"
#include "core/floating_point.h"
#include "core/not_known.h"

namespace annulus::dynamics {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

double mean_of(const std::vector<double>& values) {
  if (values.empty()) throw InputError("statistics need at least one value, not 0");
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// P(B <= k) for B binomial(n, p).
double at_most(long k, long n, double p) {
  if (k < 0) return 0;
  if (k >= n) return 1;
  return cdf(boost::math::binomial(static_cast<double>(n), p), static_cast<double>(k));
}

}  // namespace

double standard_deviation(const std::vector<double>& values) {
  if (values.size() < 2) return not_known;
  const double mean = mean_of(values);
  double sum = 0;
  for (const double x : values) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

Interval mean_interval(const std::vector<double>& values, double confidence) {
  const double mean = mean_of(values);
  if (values.size() < 2) return {mean, -unbounded, unbounded};
  const auto n = static_cast<double>(values.size());
  const boost::math::students_t law(n - 1);
  const double half = quantile(complement(law, (1 - confidence) / 2)) * standard_deviation(values) / std::sqrt(n);
  return {mean, mean - half, mean + half};
}

Interval quantile_interval(const std::vector<double>& values, double probability, double confidence) {
  if (values.empty()) throw InputError("statistics need at least one value, not 0");
  if (!(probability > 0 && probability < 1))
    throw InputError(fmt::format("a quantile needs a probability between 0 and 1, not {}", probability));
  const auto n = static_cast<long>(values.size());
  const double position = probability * static_cast<double>(n - 1);
  const auto below = static_cast<long>(position);
  const double part = position - static_cast<double>(below);
  // With B values below the true quantile, order statistic r (from 1) exceeds it when B < r: the lower end is the
  // largest r with P(B <= r - 1) <= alpha/2, the upper end the smallest with P(B <= r - 1) >= 1 - alpha/2.
  const double tail = (1 - confidence) / 2;
  // Both conditions hold from one r on (or up to one): bisection.
  const auto first = [n](const auto& holds) {
    long from = 1, to = n + 1;
    while (from < to) {
      const long middle = (from + to) / 2;
      if (holds(middle)) {
        to = middle;
      } else {
        from = middle + 1;
      }
    }
    return from;
  };
  const auto missed = [&](long r) { return at_most(r - 1, n, probability); };
  const long low = first([&](long r) { return missed(r) > tail; }) - 1;
  const long high = first([&](long r) { return missed(r) >= 1 - tail; });
  // Order statistics from 0; each search leaves the larger values behind it for the next.
  std::vector<double> sorted = values;
  auto from = sorted.begin();
  const auto ordered = [&](long i) {
    const auto at = sorted.begin() + i;
    if (at >= from) {
      std::nth_element(from, at, sorted.end());
      from = at + 1;
    }
    return *at;
  };
  Interval result{0, -unbounded, unbounded};
  if (low >= 1) result.low = ordered(low - 1);
  const double lower = ordered(below);
  result.value = part == 0 ? lower : (1 - part) * lower + part * ordered(std::min(below + 1, n - 1));
  if (high <= n) result.high = ordered(high - 1);
  return result;
}

Interval share_interval(long successes, long trials, double confidence) {
  if (trials < 1 || successes < 0 || successes > trials)
    throw InputError(fmt::format("{} successes in {} trials: successes must lie between 0 and the number of trials",
                                 successes, trials));
  using boost::math::binomial;
  const auto n = static_cast<double>(trials), k = static_cast<double>(successes);
  const double tail = (1 - confidence) / 2;
  const UntrappedFloatingPoint untrapped;  // Boost's search for the bounds comes upon "not a number" and goes on
  return {k / n, successes == 0 ? 0 : binomial::find_lower_bound_on_p(n, k, tail),
          successes == trials ? 1 : binomial::find_upper_bound_on_p(n, k, tail)};
}

}  // namespace annulus::dynamics
