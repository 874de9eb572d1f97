#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

struct Mode {
  double frequency = 0;   ///< Hz
  Eigen::VectorXd shape;  ///< mass-normalised (shape^T M shape = 1), in the order of `Modes::dofs`
};

struct Modes {
  std::vector<std::string> dofs;
  std::vector<Mode> modes;                       ///< rising frequency
  [[nodiscard]] Eigen::MatrixXd shapes() const;  ///< DOFs x modes
};

/// Mean stiffness of every mesh, N/m: over its period, and that for modes (see mesh_excitation.h).
[[nodiscard]] Eigen::VectorXd mean_stiffnesses(const LumpedSystem& system);
[[nodiscard]] Eigen::VectorXd mean_tangents(const LumpedSystem& system);

/// Undamped natural frequencies and mode shapes with constant mesh stiffnesses (N/m, one per mesh), all teeth in
/// contact, without rotation (Omega = 0). Frequencies below 1e-13 of the highest one are rigid motions and are set to
/// exactly 0. Throws SolverError when the stiffness is indefinite.
[[nodiscard]] Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);
/// The same with the mean tangents of the meshes.
[[nodiscard]] Modes modes(const LumpedSystem& system);

/// d forces / d approaches, meshes x meshes, N/m: `mesh_stiffness` on the diagonal, for coupled meshes
/// (diag(1/k) + D)^-1. D is the mean compliance. When the common body has DOFs of its own, D is taken at time 0, where
/// modes take the mesh vectors too. Throws SolverError when diag(1/k) + D is not positive definite.
[[nodiscard]] Eigen::MatrixXd mesh_stiffness_matrix(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);
/// K + B K_m B^T, N/m, K_m the matrix above and B the mesh vectors.
[[nodiscard]] Eigen::MatrixXd stiffness_with_meshes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness);

/// Does a stiffness and its transpose exert no force on a motion of unit kinetic energy, except for rounding? Compared
/// entry by entry, so that a stiff support does not hide the effect of rotation.
[[nodiscard]] bool costs_no_force(const Eigen::VectorXd& shape, const Eigen::MatrixXd& stiffness,
                                  const Eigen::MatrixXd& mass);

/// Number of modes, from the first, that are rigid and free of force under `stiffness` too (with meshes and K_Omega).
[[nodiscard]] Eigen::Index neutral_motions(const Modes& found, const Eigen::MatrixXd& stiffness,
                                           const Eigen::MatrixXd& mass);

/// Throws InputError because the load does work on a rigid motion; the message names its largest DOF.
[[noreturn]] void refuse_unbalanced(const LumpedSystem& system, const Eigen::VectorXd& shape);

}  // namespace annulus::dynamics
