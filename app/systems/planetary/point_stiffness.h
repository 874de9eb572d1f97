#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace annulus::app {

/// The stiffness of a structure in points of it: forces and moments over displacements and tilts.
struct PointStiffness {
  std::vector<std::string> points;
  /// x, y, z, about x, about y of every point, in the axes of the structure; where it `turns`, the rotation of one
  /// about z last. Rotations of other points about z, on which nothing acts, are condensed. Symmetric, and holds every
  /// coordinate.
  Eigen::MatrixXd stiffness;
  bool turns = false;
};

/// Reads a square table (docs/exchange.md) of 5 or 6 coordinates per point, <point>_x_m ... <point>_about_z_rad, for
/// some of the points of `known`, in any order. `turning`: points on which a torque may act; the rotation about z of
/// one of them is retained where the file has it. `held`: what has to be held while it is measured, for messages.
/// Throws InputError with what is wrong in it.
[[nodiscard]] PointStiffness read_point_stiffness(const std::filesystem::path& file,
                                                  const std::vector<std::string>& known,
                                                  const std::vector<std::string>& turning, const std::string& held);

}  // namespace annulus::app
