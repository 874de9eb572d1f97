#pragma once

#include <cstring>

namespace annulus::dynamics {

/// Two numbers in one SIMD register (vector type of GCC and Clang, on every processor). Built from two scalars it does
/// not pass through memory as a fixed-size array of Eigen does. Reading 16 bytes just written as 8 + 8 stalls, which
/// would take half the time of a right-hand side.
using TwoDoubles = double __attribute__((vector_size(16)));

inline TwoDoubles two_doubles_at(const double* from) {
  TwoDoubles both;
  std::memcpy(&both, from, sizeof both);
  return both;
}

inline void store(const TwoDoubles& both, double* to) { std::memcpy(to, &both, sizeof both); }

}  // namespace annulus::dynamics
