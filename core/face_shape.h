#pragma once

#include <memory>
#include <vector>

namespace annulus {

/// How a mesh presses along its face while its whole law is known: at equidistant phases of one mesh cycle, from phase
/// 0 on. With z from -1 to 1 over the face and P(z) = (3 z^2 - 1) / 2, a place presses with the share
/// (1 + slope z + curvature P(z)) dz / 2 of the law of the whole mesh under the approach there less the gap
/// gap_slope (z - slope / 3), with which straight flanks carry what the whole mesh does.
struct FaceShape {
  std::vector<double> slope, curvature;
  std::vector<double> gap_slope;  ///< m, normal to the flanks
  /// The same with the mean stiffness and moment between two tilts, where one end or the other approaches by half as
  /// much again as the middle, instead of those without tilt. What a result changes by with it is what the straight law
  /// leaves open. Null: not known.
  std::shared_ptr<const FaceShape> tilted{};
};

}  // namespace annulus
