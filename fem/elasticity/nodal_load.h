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

/// Stress of a free surface at one of its nodes, as functionals of the displacement (Pa per m): along the surface in
/// the cross-section, and of a solid also along the axis and the shear between both.
///
/// Without traction on the surface its tangent plane is in plane stress, so that displacements of the surface alone
/// give it: sigma_t = E / (1 - nu^2) (eps_t + nu eps_z), likewise sigma_z; tau = G gamma_tz. In the plane eps_z = 0.
struct SurfaceStress {
  int node = 0;
  NodalLoad tangential, axial, shear;
};

}  // namespace annulus::fem
