#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

struct Mode {
  double frequency = 0;   ///< Hz
  Eigen::VectorXd shape;  ///< mass-normalised (shape^T M shape = 1), in the order of `Modes::DOFs`
};

struct Modes {
  std::vector<std::string> dofs;
  std::vector<Mode> modes;  ///< rising frequency
};

/// Undamped natural frequencies and mode shapes with constant mesh stiffnesses (N/m, one per mesh), all teeth in
/// contact, without rotation (Omega = 0). Frequencies below 1e-13 of the highest one are rigid motions and given as
/// exactly 0. Throws SolverError when the stiffness is indefinite.
[[nodiscard]] Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

/// d forces / d closings, meshes x meshes, N/m: the given stiffnesses on the diagonal; of coupled meshes
/// (diag(1/k) + D)^-1, D the mean compliance (the one at time 0 when the common body has DOFs of its own, for their
/// part in it changes with the mesh vectors, which modes take at time 0).
[[nodiscard]] Eigen::MatrixXd mesh_stiffness_matrix(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);
/// K + B K_m B^T, N/m, K_m the matrix above and B the mesh vectors.
[[nodiscard]] Eigen::MatrixXd stiffness_with_meshes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

/// Does a motion (of unit kinetic energy, as shapes are) meet no force of a stiffness, in either direction, but for
/// rounding? Entry by entry, so that a stiff support does not hide what rotation does.
[[nodiscard]] bool costs_no_force(const Eigen::VectorXd& shape, const Eigen::MatrixXd& stiffness,
                                  const Eigen::MatrixXd& mass);

/// Number of modes, from the first, that are rigid and meet no force of `stiffness` (with the meshes and K_Omega)
/// either.
[[nodiscard]] Eigen::Index neutral_motions(const Modes& found, const Eigen::MatrixXd& stiffness,
                                           const Eigen::MatrixXd& mass);

/// Throws InputError: the load does work on a rigid motion; names what moves most in it.
[[noreturn]] void refuse_unbalanced(const LumpedSystem& system, const Eigen::VectorXd& shape);

}  // namespace annulus::dynamics
