#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace annulus::dynamics {

/// A uniform number in (0, 1) that depends on its three arguments alone. Draws are the same for any thread count, order
/// and number of samples, and a quantity added later does not change the others.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::uint64_t sample, std::string_view quantity);

/// The same for many draws of one quantity, a hundred times as fast. Sample i is the i-th output of SplitMix64
/// [SteeleLeaFlood2014], a function of its counter, from a start that depends on seed and quantity. The numbers differ
/// from those of uniform_draw.
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

/// Distribution of an uncertain quantity.
struct Distribution {
  enum class Kind { uniform, normal, lognormal, rayleigh };
  Kind kind = Kind::uniform;
  /// Mean and standard deviation of the quantity before truncation; for a lognormal one too, not of its logarithm.
  double mean = 0, deviation = 0;
  /// Ends of the uniform distribution. The others are truncated there: distributions under the condition low <= value
  /// <= high. Values are never moved to an end.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  double scale = 0;  ///< Rayleigh only, instead of mean and deviation: sqrt(2/pi) x mean

  /// Throws InputError for missing ends (uniform), ends in the wrong order, or a deviation, scale or lognormal mean
  /// that is not positive. At least a thousandth of the distribution must lie between the ends.
  void check() const;
  /// The value below which the quantity lies with this probability in (0, 1).
  [[nodiscard]] double quantile(double probability) const;
};

}  // namespace annulus::dynamics
