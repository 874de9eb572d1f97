#pragma once

#include <limits>

namespace annulus {

/// Stands for a number that is not known: NaN.
inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

}  // namespace annulus
