#include "dynamics/system/input_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"

namespace annulus::dynamics {

void check_positive(double value, const std::string& name) {
  if (!std::isfinite(value) || !(value > 0))
    throw InputError(fmt::format("{} = {} must be positive and finite", name, value));
}

void check_not_negative(double value, const std::string& name) {
  if (!std::isfinite(value) || !(value >= 0))
    throw InputError(fmt::format("{} = {} must not be negative, and finite", name, value));
}

void check_support(double value, const std::string& name, ZeroStiffness zero) {
  const bool zero_allowed = zero == ZeroStiffness::allowed;
  if (!(value > 0 || (zero_allowed && value == 0)))
    throw InputError(fmt::format("{} = {} N/m must {} (absent or inf: rigid)", name, value,
                                 zero_allowed ? "not be negative" : "be positive"));
}

}  // namespace annulus::dynamics
