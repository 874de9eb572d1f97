#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/beam.h"

namespace annulus::dynamics {

/// The side of a body's middle, along z, on which something stands.
enum class Side { low, high };

/// Forces along x, y, z and moments about x, y over displacements and tilts.
using EndStiffness = Eigen::Matrix<double, 5, 5>;

/// Of the free end of a beam along z that is clamped in a wall: how it bends along x and along y.
[[nodiscard]] EndStiffness beam_end(const Beam& along_x, const Beam& along_y, double length, Side wall);

/// A carrier of two rigid walls with webs between them. The pins of the planets are clamped in both. One wall has the
/// shaft and is the body of the carrier: the other one winds up against it.
struct TwoWallCarrier {
  std::vector<double> planet_angles;  ///< rad
  double radius = 0;                  ///< m, of the planets' axes
  Beam pin;
  double pin_length = 0;  ///< m, from wall to wall; the planets are in the middle
  int webs = 0;
  double web_radius = 0, web_length = 0;         ///< m; the length from wall to wall
  double first_web = 0;                          ///< rad; the others are evenly spaced
  double web_width = 0, web_depth = 0;           ///< m, tangential and radial
  double youngs_modulus = 0, poisson_ratio = 0;  ///< Pa; of the webs
  Side shaft = Side::low;                        ///< of the wall that has it
};
/// Of all planets' pins in the middle of the planets, against the wall with the shaft: 5 coordinates per planet,
/// radial, tangential, axial, about radial and tangential. Throws InputError for sizes that are not positive and fewer
/// than two webs.
[[nodiscard]] Eigen::MatrixXd pins_stiffness(const TwoWallCarrier& carrier);

}  // namespace annulus::dynamics
