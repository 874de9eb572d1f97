#pragma once

#include <string>

namespace annulus::dynamics {

/// These throw InputError naming the quantity.
void check_positive(double value, const std::string& name);
void check_not_negative(double value, const std::string& name);
/// A stiffness, N/m, which may be infinite.
void check_support(double value, const std::string& name, bool zero_allowed);

}  // namespace annulus::dynamics
