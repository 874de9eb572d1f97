#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// A unit load on one node of a sector, and the displacement that is its work partner.
struct Port {
  int node = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< in the sector's own frame
};

/// A sector reduced exactly to its two radial cuts (low, then high) and its ports.
struct CondensedSector {
  int dimension = 2;
  double pitch_angle = 0;
  std::vector<Eigen::Vector3d> cut_points;  ///< of the low cut
  Eigen::MatrixXd cut_stiffness;            ///< 2m x 2m, low freedoms then high ones
  Eigen::MatrixXd cut_load;                 ///< 2m x ports: load on the cuts equivalent to a unit port load
  Eigen::MatrixXd port_compliance;          ///< ports x ports, with both cuts held
};

/// `floating`: no boundary of the sector is held.
[[nodiscard]] CondensedSector condense(const SectorModel& model, const std::vector<Port>& ports, bool floating);

}  // namespace annulus::fem
