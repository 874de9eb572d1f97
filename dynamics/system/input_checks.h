#pragma once

#include <string>

namespace annulus::dynamics {

/// These throw InputError with name and value of the quantity.
void check_positive(double value, const std::string& name);
void check_not_negative(double value, const std::string& name);
enum class ZeroStiffness { allowed, refused };
/// Accepts a positive or infinite (rigid) stiffness, N/m, and zero where it is allowed.
void check_support(double value, const std::string& name, ZeroStiffness zero);

}  // namespace annulus::dynamics
