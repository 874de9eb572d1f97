#include "dynamics/statistics/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/rayleigh.hpp>
#include <cmath>
#include <random>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// FNV-1a, 64 bits: fixed for all platforms, unlike std::hash.
std::uint64_t name_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

/// The tail that probabilities are taken from: the smaller one loses fewer digits.
enum class Tail { lower, upper };

/// Probability of [low, high].
template <class Law>
double probability_between(const Law& law, double low, double high, Tail tail) {
  if (tail == Tail::upper) return cdf(complement(law, low)) - (std::isinf(high) ? 0 : cdf(complement(law, high)));
  return (std::isinf(high) ? 1 : cdf(law, high)) - (std::isinf(low) ? 0 : cdf(law, low));
}

template <class Law>
Tail tail_of(const Law& law, double low) {
  return std::isfinite(low) && low > median(law) ? Tail::upper : Tail::lower;
}

template <class Law>
double truncated_quantile(const Law& law, double low, double high, double p) {
  const Tail tail = tail_of(law, low);
  const double share = probability_between(law, low, high, tail);
  const double x = tail == Tail::upper ? quantile(complement(law, cdf(complement(law, low)) - p * share))
                                       : quantile(law, (std::isinf(low) ? 0 : cdf(law, low)) + p * share);
  return std::clamp(x, low, high);  // rounding of the quantile only
}

boost::math::lognormal lognormal_law(const Distribution& d) {
  const double variance = std::log1p(d.deviation * d.deviation / (d.mean * d.mean));
  return {std::log(d.mean) - variance / 2, std::sqrt(variance)};
}

/// Calls use(law, low, high) with the law of a distribution that is not uniform and its ends within the law's range.
template <class Use>
double with_law(const Distribution& d, const Use& use) {
  if (d.kind == Distribution::Kind::normal) return use(boost::math::normal(d.mean, d.deviation), d.low, d.high);
  const double low = std::max(d.low, 0.0);
  if (d.kind == Distribution::Kind::rayleigh) return use(boost::math::rayleigh(d.scale), low, d.high);
  return use(lognormal_law(d), low, d.high);
}

std::uint64_t random_word(std::uint64_t seed, std::uint64_t sample, std::string_view quantity) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  const std::uint64_t name = name_hash(quantity);
  // Both the seeding and the generator are fixed bit by bit in the C++ standard.
  std::seed_seq words{low(seed), high(seed), low(sample), high(sample), low(name), high(name)};
  std::mt19937_64 generator(words);
  return generator();
}

}  // namespace

double uniform_draw(std::uint64_t seed, std::uint64_t sample, std::string_view quantity) {
  // The middle of one of 2^53 equal intervals: never 0 or 1.
  return (static_cast<double>(random_word(seed, sample, quantity) >> 11) + 0.5) * 0x1p-53;
}

CounterDraws::CounterDraws(std::uint64_t seed, std::string_view quantity) : start_(random_word(seed, 0, quantity)) {}

void Distribution::check() const {
  if (std::isnan(mean) || std::isnan(deviation) || std::isnan(low) || std::isnan(high) || !(low < high))
    throw InputError(fmt::format("the lower end {} must lie below the upper one, {} (mean {}, deviation {})", low, high,
                                 mean, deviation));
  if (kind == Kind::uniform) {
    if (!std::isfinite(low) || !std::isfinite(high))
      throw InputError(fmt::format("a uniform distribution needs both ends, not {} ... {}", low, high));
    return;
  }
  if (kind == Kind::rayleigh) {
    if (!std::isfinite(scale) || !(scale > 0))
      throw InputError(fmt::format("the scale {} of a Rayleigh distribution must be positive", scale));
  } else if (!std::isfinite(deviation) || !(deviation > 0)) {
    throw InputError(fmt::format("the deviation {} must be above zero", deviation));
  }
  if (kind == Kind::lognormal && !(mean > 0))
    throw InputError(fmt::format("the mean {} of a lognormal distribution must be positive", mean));
  const double share =
      kind != Kind::normal && !(high > 0) ? 0.0 : with_law(*this, [](const auto& law, double from, double to) {
        return probability_between(law, from, to, tail_of(law, from));
      });
  if (!(share >= 1e-3))
    throw InputError(fmt::format("{:.2g} of the distribution lies between its ends {} and {}; at least 0.001 is needed",
                                 share, low, high));
}

double Distribution::quantile(double probability) const {
  if (!(probability > 0 && probability < 1))
    require(false, fmt::format("quantile of a probability {} outside (0, 1)", probability));
  if (kind != Kind::uniform)
    return with_law(
        *this, [&](const auto& law, double from, double to) { return truncated_quantile(law, from, to, probability); });
  return low + probability * (high - low);
}

}  // namespace annulus::dynamics
