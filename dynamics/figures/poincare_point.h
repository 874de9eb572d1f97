#pragma once

namespace annulus::dynamics {

/// State of a mesh at the start of a mesh cycle.
struct PoincarePoint {
  double force = 0;       ///< N
  double deflection = 0;  ///< m
};

}  // namespace annulus::dynamics
