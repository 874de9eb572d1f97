#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/spatial/stage_bearing.h"
#include "dynamics/systems/helical_pair/helical_pair.h"

namespace annulus::dynamics {

/// A helical pair whose gears lie in bearings with places, and tilt; SI. x points from the axis of the pinion to that
/// of the wheel, z along the axes, with the middle of the face of [stage] at 0; a positive torque of the pinion is
/// counter-clockwise.
///
/// Driving flanks have the normal n = c (cos a y + sin a x) - s z from the pinion into the wheel, with the working
/// angle a, c = cos(base helix angle), s = sin(base helix angle); both flanks' places rho(z) are on the working pitch
/// line:
///
///   delta(z) = n . [u_1 + phi_1 x rho_1(z) - u_2 - phi_2 x rho_2(z)]
struct SpatialPair {
  double base_helix_angle = 0;                                 ///< rad, as in HelicalPair
  double working_angle = 0;                                    ///< rad, transverse
  double working_radius_pinion = 0, working_radius_wheel = 0;  ///< m, of the pitch points from the axes
  double pinion_torque = 0;                                    ///< N m, positive
  double stiffness = 0;  ///< N/m along the normal, of the mesh, spread evenly over the face
  SpreadFace face;       ///< gaps normal to the flanks
  std::vector<StageBearing> bearings;
  std::vector<StageLoad> loads;
  std::vector<StageWeight> weights;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2

  /// Why bodies move along the axis and tilt; empty: nothing makes them, and these degrees of freedom are left out.
  [[nodiscard]] std::vector<std::string> reasons_for_space() const;
};

/// Throws InputError where a gear can move and nothing resists, or two rigid bearings do the same; any stiffness > 0 of
/// the mesh shows it.
void check_held(const SpatialPair& pair);

/// The pair in space for small motions about its equilibrium: bearings with clearance, rollers and tables have their
/// tangents there and the forces they bear. Where nothing calls for it, no gear moves along the axis or tilts. Throws
/// InputError for bearings of other bodies or on others than the housing, and what Mechanism::solve() throws.
[[nodiscard]] PairSpace pair_about_equilibrium(const SpatialPair& pair, double tilt_inertia_pinion,
                                               double tilt_inertia_wheel);

}  // namespace annulus::dynamics
