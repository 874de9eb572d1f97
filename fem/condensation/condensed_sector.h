#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elasticity/nodal_load.h"
#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// A unit load on one node of a sector, and the displacement that is its work partner.
struct Port {
  int node = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< in the sector's own frame
};

/// What a sector is loaded with and asked for. The nodes of ports are retained: there are many, all coupled. Other
/// loads are eliminated with the interior: a few patterns over many nodes.
struct SectorLoads {
  std::vector<Port> ports;
  std::vector<NodalLoad> acting;    ///< loads
  std::vector<NodalLoad> observed;  ///< functionals of the displacement that are only asked for
  [[nodiscard]] int columns() const { return static_cast<int>(ports.size() + acting.size() + observed.size()); }
  [[nodiscard]] int acting_columns() const { return static_cast<int>(ports.size() + acting.size()); }
};

/// A sector reduced exactly to its two cyclic interfaces (low, then high) and its loads: ports, acting, observed.
struct CondensedSector {
  int dimension = 2;
  double pitch_angle = 0;
  std::vector<Eigen::Vector3d> interface_points;  ///< of the low interface
  std::vector<int> interface_dofs;      ///< of every interface point: its first displacements, x and y, mostly z; sum m
  Eigen::MatrixXd interface_stiffness;  ///< 2m x 2m, low DOFs then high ones
  Eigen::MatrixXd interface_load;       ///< 2m x loads: load on the interfaces equivalent to a unit load
  Eigen::MatrixXd compliance;           ///< loads x (ports and acting), with both interfaces held
  int ports = 0;

  /// Whether some points stay in a plane across the axis: the ring can then neither tilt nor move along its axis.
  [[nodiscard]] bool axially_held() const;
  /// The columns of displacements of a interface, from `first` on, turned from the frame of its own sector into that of
  /// the sector before: times the rotation by the pitch.
  void turn_columns(Eigen::MatrixXd& matrix, Eigen::Index first) const;
};

/// The sector with some of its acting loads, first ... first + weights.rows() - 1, replaced by combinations of them,
/// one per column of `weights`.
[[nodiscard]] CondensedSector combine_loads(CondensedSector sector, int first, const Eigen::MatrixXd& weights);

[[nodiscard]] CondensedSector condense(const SectorModel& model, const SectorLoads& loads, SectorSupport support);

}  // namespace annulus::fem
