#pragma once

#include <vector>

namespace annulus::dynamics {

/// An estimate with its confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;
};

inline constexpr double usual_confidence = 0.95;

/// Mean with Student's t interval, which is exact for normal values. For others it is as good as their mean is normal.
/// Fewer than two values give infinite ends. Throws InputError without values.
[[nodiscard]] Interval mean_interval(const std::vector<double>& values, double confidence = usual_confidence);

/// Standard deviation of the population the values are drawn from (divisor n - 1); NaN for fewer than two.
[[nodiscard]] double standard_deviation(const std::vector<double>& values);

/// Quantile, linear between order statistics (type 7 of [HyndmanFan1996]), with the distribution-free interval between
/// two order statistics. The number of values below the true quantile is binomial, so each end is missed with
/// probability (1 - confidence)/2 at most. An end for which there are too few values is infinite.
/// Throws InputError without values or for a probability outside (0, 1).
[[nodiscard]] Interval quantile_interval(const std::vector<double>& values, double probability,
                                         double confidence = usual_confidence);

/// Share of successes with the exact interval of [ClopperPearson1934].
/// Throws InputError unless 0 <= successes <= trials and trials > 0.
[[nodiscard]] Interval share_interval(long successes, long trials, double confidence = usual_confidence);

}  // namespace annulus::dynamics
