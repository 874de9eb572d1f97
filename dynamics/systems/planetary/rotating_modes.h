#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/systems/planetary/mode_kind.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

enum class ModeDamping { undamped, damped };

/// A mode of the turning stage, e^(lambda t) in the carrier-fixed frame.
struct RotatingMode {
  double frequency = 0;  ///< Hz, |Im lambda| / 2 pi
  /// -Re lambda / |lambda|: 0 for rigid motions, 1 for a decay without oscillation, -1 for growth without oscillation.
  double damping_ratio = 0;
  ModeKind kind = ModeKind::mixed;
  Eigen::VectorXcd shape;  ///< phi^H M phi = 1, largest entry real, in the order of `RotatingModes::dofs`
};

struct RotatingModes {
  double carrier_speed = 0;  ///< rad/s
  std::vector<std::string> dofs;
  std::vector<RotatingMode> modes;  ///< rising frequency, one per DOF
};

/// Modes of M q'' + (C + G) q' + (K + K_Omega) q = 0 at the carrier speed of the stage, with the mean tangent mesh
/// stiffness and all teeth in contact; see [CooleyParker2012]. ModeDamping::damped includes the dampers of supports,
/// bearings and meshes. Without them G and the centripetal part alone make the modes depend on speed. Frequencies below
/// 1e-6 of the highest one are rigid motions and are set to exactly 0. Throws InputError when the stage cannot be
/// assembled, SolverError when the eigenvalue solver fails.
[[nodiscard]] RotatingModes rotating_modes(const PlanetaryStage& stage, ModeDamping damping);

}  // namespace annulus::dynamics
