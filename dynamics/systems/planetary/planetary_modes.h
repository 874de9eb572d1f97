#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/modes/modal_energy.h"
#include "dynamics/modes/modes.h"
#include "dynamics/systems/planetary/mode_kind.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// The modes of a stage and the kind of each, `kinds[i]` that of `modes[i]`.
struct PlanetaryModes : Modes {
  std::vector<ModeKind> kinds;
};

/// Undamped natural frequencies and mode shapes with the mean tangent mesh stiffness, all teeth in contact, without
/// rotation (Omega = 0). Shapes of one multiple frequency are combined so that each is of one kind.
/// Throws InputError when the stage cannot be assembled, SolverError when the stiffness is indefinite.
[[nodiscard]] PlanetaryModes modes(const PlanetaryStage& stage);

/// Mean tangent stiffness of every mesh of the assembled stage, N/m, in the order of its meshes.
[[nodiscard]] Eigen::VectorXd mean_mesh_stiffness(const PlanetaryStage& stage);
/// Distribution of the energy of the modes of `modes(stage)`.
[[nodiscard]] ModalEnergy modal_energy(const PlanetaryStage& stage, const Modes& modes);

}  // namespace annulus::dynamics
