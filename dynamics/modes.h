#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/lumped_system.h"
#include "dynamics/mode_kind.h"
#include "dynamics/planetary_stage.h"

namespace annulus::dynamics {

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
/// rotation (Omega = 0). Frequencies below 1e-6 of the highest one are rigid motions and given as exactly 0. Shapes of
/// one multiple frequency are turned so that each is of one kind.
/// Throws InputError when the stage cannot be assembled, SolverError when the stiffness is indefinite.
[[nodiscard]] Modes modes(const PlanetaryStage& stage);

/// The same for any system with given constant mesh stiffnesses (one per mesh); every kind is `mixed`.
[[nodiscard]] Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

/// Mean tangent stiffness of every mesh of the assembled stage, N/m, in the order of its meshes.
[[nodiscard]] Eigen::VectorXd mean_mesh_stiffness(const PlanetaryStage& stage);
/// K + sum k_m b_m b_m^T, N/m.
[[nodiscard]] Eigen::MatrixXd stiffness_with_meshes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

}  // namespace annulus::dynamics
