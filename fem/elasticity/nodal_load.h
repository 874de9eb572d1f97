#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::fem {

/// A force on one node of a sector, in the sector's own frame.
struct NodalForce {
  int node = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// Forces on some nodes; at the same time a linear functional of the displacement: the work they do. Loads are forces
/// of unit size (N, in the plane N per metre of width), observed quantities (a stress) have their own unit.
using NodalLoad = std::vector<NodalForce>;

}  // namespace annulus::fem
