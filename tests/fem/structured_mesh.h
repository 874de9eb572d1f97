#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

#include "geometry/mesh.h"

namespace annulus::tests {

/// Tags of the sides of a structured mesh: u low, u high, v low, v high and, in three dimensions, w low, w high.
using SideTags = std::array<geometry::Boundary, 6>;

/// The unit square or cube cut into nu x nv (x nw) equal cells and mapped, orientation kept by the map.
geometry::Mesh structured_mesh(int nu, int nv, const std::function<Eigen::Vector2d(double, double)>& map,
                               const SideTags& tags);
geometry::Mesh structured_mesh(int nu, int nv, int nw,
                               const std::function<Eigen::Vector3d(double, double, double)>& map, const SideTags& tags);

/// The unit square or cube with n cells a side; every inner vertex is displaced by up to `distortion` cell sizes in a
/// fixed pseudo-random direction, so that no two cells are alike. All sides are tagged `inner`, which is not curved.
geometry::Mesh distorted_box(int dimension, int n, double distortion);

}  // namespace annulus::tests
