#pragma once

#include <Eigen/Core>

#include "core/elastic_law.h"

namespace annulus {

/// Force (N) and moment over half the face width (N) of straight flanks, which approach by `approach` (m) in the middle
/// of the face and by `tilt` (m) more at its end.
struct FaceLoad {
  Eigen::Vector2d force;
  Eigen::Matrix2d tangent;    ///< N/m, over approach and tilt
  double energy = 0;          ///< J
  Eigen::VectorXd line_load;  ///< N/m, at the stations
};
[[nodiscard]] FaceLoad load_of_straight_flanks(const FaceLaw& law, double approach, double tilt);

/// The approach (m) of straight flanks that do not tilt under a force (N) > 0. Throws SolverError where it is not
/// found.
[[nodiscard]] double approach_under(const FaceLaw& law, double force);

/// Straight flanks that carry a force (N) > 0 whose resultant stands `place` (m) from the middle of the face.
struct FlanksUnderLoad {
  double approach = 0, tilt = 0;  ///< m
  FaceLoad load;
  /// N/m, by how much the moment over half the face width grows with the tilt under the same force.
  [[nodiscard]] double tilt_stiffness() const;
};
/// Throws SolverError where none are found, as where the place is close to the end of the face or beyond it.
[[nodiscard]] FlanksUnderLoad flanks_under(const FaceLaw& law, double force, double place);

}  // namespace annulus
