#include "core/whole_ratio.h"

#include <cmath>

namespace annulus {

std::optional<std::pair<long, long>> whole_ratio(double value) {
  constexpr double same = 1e-9;
  constexpr long largest = 1000000;
  // Continued fraction.
  long a0 = 0, a1 = 1, b0 = 1, b1 = 0;
  double rest = value;
  for (;;) {
    const double whole = std::floor(rest + same);
    if (whole > static_cast<double>(largest)) return std::nullopt;
    const long w = static_cast<long>(whole), a = w * a1 + a0, b = w * b1 + b0;
    if (a > largest || b > largest) return std::nullopt;
    a0 = std::exchange(a1, a);
    b0 = std::exchange(b1, b);
    if (std::abs(static_cast<double>(a1) / static_cast<double>(b1) - value) <= same * value) return std::pair{a1, b1};
    rest = 1 / (rest - whole);
  }
}

}  // namespace annulus
