#pragma once

#include <cfenv>

namespace annulus {

/// For the scope of calls that come upon infinity or "not a number" on purpose and look at what they have got: traps
/// that are set (the tests set them) wait, flags that are raised meanwhile are forgotten.
class UntrappedFloatingPoint {
 public:
  UntrappedFloatingPoint() { std::feholdexcept(&before_); }
  ~UntrappedFloatingPoint() { std::fesetenv(&before_); }
  UntrappedFloatingPoint(const UntrappedFloatingPoint&) = delete;
  UntrappedFloatingPoint& operator=(const UntrappedFloatingPoint&) = delete;

 private:
  std::fenv_t before_{};
};

}  // namespace annulus
