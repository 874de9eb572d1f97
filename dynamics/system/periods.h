#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace annulus::dynamics {

/// The period, in cycles, of what has none.
inline constexpr int never_repeats = 1 << 30;

/// The least common multiple of two periods, as far as it stays below never_repeats.
[[nodiscard]] inline int common_period(int a, int b) {
  const auto both = std::lcm(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b));
  return static_cast<int>(std::min<std::int64_t>(both, never_repeats));
}

/// A number of periods, as far as it stays below never_repeats.
[[nodiscard]] inline int times_period(int number, int period) {
  return static_cast<int>(std::min(static_cast<std::int64_t>(number) * period, std::int64_t{never_repeats}));
}

}  // namespace annulus::dynamics
