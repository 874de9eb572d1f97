#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::fem {

/// Forces on the flank of one tooth, N at the ports of its body.
struct ToothForces {
  int tooth = 0;
  Eigen::VectorXd ports;
};

/// All forces of one position.
struct ContactForces {
  std::vector<ToothForces> pinion, wheel;
  Eigen::VectorXd supports;  ///< of the wheel's support row; empty without
  /// Motion of a floating ring beyond its elastic displacement: x, y (m), rotation about z (rad); of a whole solid one
  /// also about x and y. Empty without supports.
  Eigen::VectorXd rigid;
  Eigen::VectorXd rollers, pinion_rigid;  ///< the same of a planet on rollers, forces of its other mesh included
};

}  // namespace annulus::fem
