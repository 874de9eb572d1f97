#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

namespace annulus::random {

/// Random numbers of one scene; the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * boost::random::uniform_01<double>()(engine_);
  }
  [[nodiscard]] double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  /// Both ends included.
  [[nodiscard]] long integer(long low, long high) {
    return boost::random::uniform_int_distribution<long>(low, high)(engine_);
  }
  [[nodiscard]] bool chance(double probability) { return uniform(0, 1) < probability; }
  template <class T>
  [[nodiscard]] const T& one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(integer(0, static_cast<long>(list.size()) - 1))];
  }

 private:
  boost::random::mt19937_64 engine_;
};

/// As people write numbers into scenes: four significant digits.
[[nodiscard]] inline double rounded(double value, int digits = 4) {
  if (value == 0) return 0;
  // Dividing by a whole power of ten gives the nearest number to the decimal one; multiplying by a fraction does not.
  const int places = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double power = std::pow(10.0, std::abs(places));
  return places >= 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

}  // namespace annulus::random
