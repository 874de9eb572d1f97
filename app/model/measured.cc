#include "app/model/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene/scene_value.h"

namespace annulus::app {

bool same(const Measured& a, const Measured& b) {
  constexpr double rounding = 1e-9;  // of sums over some thousand steps
  return std::abs(a.value - b.value) <= rounding * std::max(std::abs(a.value), std::abs(b.value));
}

bool told_apart(const Measured& a, const Measured& b) {
  const double errors = a.error + b.error;
  return std::isfinite(errors) && std::abs(a.value - b.value) > errors;
}

std::string both_text(const Measured& a, const Measured& b, int digits) {
  return fmt::format("'{}' {} and '{}' {}", a.variant, to_text(a.value, digits), b.variant, to_text(b.value, digits));
}

std::string undecided_text(const Measured& a, const Measured& b, int digits) {
  return both_text(a, b, digits) +
         (std::isfinite(a.error + b.error) ? " differ by less than the error bars" : " have no known error");
}

std::string difference_text(const Measured& a, const Measured& b, int digits) {
  const double difference = b.value - a.value;
  if (same(a, b)) return fmt::format("'{}' and '{}' are the same", a.variant, b.variant);
  if (!told_apart(a, b)) return undecided_text(a, b, digits);
  const std::string amount =
      a.value != 0 ? fmt::format("{} %", to_text(100 * std::abs(difference / a.value), 2)) : to_text(difference, 2);
  return fmt::format("'{}' {} is {} {} than '{}' {}, more than the error bars together", b.variant,
                     to_text(b.value, digits), amount, difference > 0 ? "larger" : "smaller", a.variant,
                     to_text(a.value, digits));
}

}  // namespace annulus::app
