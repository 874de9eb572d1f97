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
  std::vector<ToothForces> planet, wheel;
  Eigen::VectorXd supports;  ///< of the support row; empty without
};

}  // namespace annulus::fem
