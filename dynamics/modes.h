#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/lumped_system.h"
#include "dynamics/planetary_stage.h"

namespace annulus::dynamics {

/// Lin and Parker (J. Vib. Acoust. 121, 1999): rotational: the central bodies only turn and all planets move alike;
/// translational: the central bodies do not turn (in pairs); planet: the central bodies stand still.
/// `mixed`: none of them (planets not equally spaced).
enum class ModeKind { rotational, translational, planet, mixed };
[[nodiscard]] std::string to_string(ModeKind kind);

struct Mode {
  double frequency = 0;  ///< Hz
  ModeKind kind = ModeKind::mixed;
  Eigen::VectorXd shape;  ///< mass-normalised (shape^T M shape = 1), in the order of `Modes::freedoms`
};

struct Modes {
  std::vector<std::string> freedoms;
  std::vector<Mode> modes;  ///< rising frequency
};

/// Undamped natural frequencies and mode shapes with the mean tangent mesh stiffness, all teeth in contact, without
/// rotation (Omega = 0). Frequencies below 1e-6 of the highest one are rigid motions and given as exactly 0.
/// Throws InputError when the stage cannot be assembled, SolverError when the stiffness is indefinite.
[[nodiscard]] Modes modes(const PlanetaryStage& stage);

/// The same for any system with given constant mesh stiffnesses (one per mesh); every kind is `mixed`.
[[nodiscard]] Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

}  // namespace annulus::dynamics
