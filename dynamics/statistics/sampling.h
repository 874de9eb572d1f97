#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace annulus::dynamics {

/// A number in (0, 1), uniform, that depends on nothing but its three arguments: draws are the same for any thread
/// count, any order and any number of samples, and a quantity added later leaves the others as they were.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::uint64_t sample, std::string_view quantity);

/// The same for many draws of one quantity, a hundred times as fast: sample i is the i-th output of SplitMix64 (Steele,
/// Lea and Flood, OOPSLA 2014), which is a function of its counter, from a start that depends on seed and quantity. The
/// numbers differ from those of uniform_draw.
class CounterDraws {
 public:
  CounterDraws(std::uint64_t seed, std::string_view quantity);
  [[nodiscard]] double operator()(std::uint64_t sample) const {
    std::uint64_t z = start_ + (sample + 1) * 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  }

 private:
  std::uint64_t start_;
};

/// What is known about an uncertain quantity.
struct Distribution {
  enum class Kind { uniform, normal, lognormal, rayleigh };
  Kind kind = Kind::uniform;
  double mean = 0, deviation = 0;  ///< of the quantity itself before truncation; lognormal too (not of its logarithm)
  /// Ends of the uniform distribution; of the others the ends at which they are truncated, that is the distribution
  /// under the condition low <= value <= high. Values are never moved to an end.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double scale = 0;  ///< rayleigh alone, which has no use for mean and deviation: sqrt(2/pi) x its mean

  /// Throws InputError without ends (uniform), with ends in the wrong order, with a deviation or scale that is not
  /// positive, a lognormal mean that is not positive, or when the truncation keeps less than a thousandth of the
  /// distribution.
  void check() const;
  /// The value below which the quantity lies with this probability in (0, 1).
  [[nodiscard]] double quantile(double probability) const;
};

}  // namespace annulus::dynamics
