#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace annulus::dynamics {

/// A number in (0, 1), uniform, that depends on nothing but its three arguments: draws are the same for any thread
/// count, any order and any number of samples, and a quantity added later leaves the others as they were.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::uint64_t sample, std::string_view quantity);

/// What is known about an uncertain quantity.
struct Distribution {
  enum class Kind { uniform, normal, lognormal };
  Kind kind = Kind::uniform;
  double mean = 0, deviation = 0;  ///< of the quantity itself before truncation; lognormal too (not of its logarithm)
  /// Ends of the uniform distribution; of the others the ends at which they are truncated, that is the distribution
  /// under the condition low <= value <= high. Values are never moved to an end.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  /// Throws InputError without ends (uniform), with ends in the wrong order, with a deviation that is not positive, a
  /// lognormal mean that is not positive, or when the truncation keeps less than a thousandth of the distribution.
  void check() const;
  /// The value below which the quantity lies with this probability in (0, 1).
  [[nodiscard]] double quantile(double probability) const;
};

}  // namespace annulus::dynamics
