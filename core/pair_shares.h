#pragma once

#include <vector>

namespace annulus {

/// How the tooth pairs of a mesh share its load over the mesh cycle, at the nominal load: the mean over all ring
/// positions.
struct PairShares {
  int phases = 0;                            ///< 0: not known
  int first = 0;                             ///< mesh cycles by which the first pair passes the pitch point later
  std::vector<std::vector<double>> share{};  ///< [phase][pair]; those of each phase add up to 1
};

}  // namespace annulus
