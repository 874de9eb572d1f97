#pragma once

#include <cstring>

namespace annulus::dynamics {

/// Two numbers in one register (vector type of GCC and Clang, on every processor). Built from two scalars it does not
/// pass through memory as a fixed-size array of Eigen does: reading 16 bytes just written as 8 + 8 stalls, and would
/// take half the time of a right-hand side.
using Pair = double __attribute__((vector_size(16)));

inline Pair pair_at(const double* place) {
  Pair pair;
  std::memcpy(&pair, place, sizeof pair);
  return pair;
}

inline void store(const Pair& pair, double* place) { std::memcpy(place, &pair, sizeof pair); }

}  // namespace annulus::dynamics
