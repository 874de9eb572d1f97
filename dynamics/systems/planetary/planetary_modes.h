#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/modes/modal_energy.h"
#include "dynamics/spatial/stage_bodies.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// Kinds of modes of equally spaced planets [LinParker1999], in space [EritenelParker2009].
enum class ModeKind {
  rotational,     ///< central bodies only turn (in space: and move along the axis), all planets move equally
  translational,  ///< central bodies do neither (in space: but tilt); in pairs from three planets on
  planet,         ///< central bodies stand still, planets move differently
  mixed           ///< none of them: planets not equally spaced, or a single one
};
/// In space "rotational-axial" and "translational-tilting".
[[nodiscard]] std::string to_string(ModeKind kind, Motions motions = Motions::in_plane);

/// The modes of a stage and the kind of each, `kinds[i]` that of `modes[i]`.
struct PlanetaryModes : Modes {
  std::vector<ModeKind> kinds;
};

/// Undamped natural frequencies and mode shapes with the mean tangent mesh stiffness, all teeth in contact, without
/// rotation (Omega = 0). Shapes of one multiple frequency are combined so that each is of one kind.
/// Throws InputError when the stage cannot be assembled, SolverError when the stiffness is indefinite.
[[nodiscard]] PlanetaryModes modes(const PlanetaryStage& stage);

/// Distribution of the energy of the modes of `modes(stage)`.
[[nodiscard]] ModalEnergy modal_energy(const PlanetaryStage& stage, const Modes& modes);

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
