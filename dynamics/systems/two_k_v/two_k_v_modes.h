#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/modes/modal_energy.h"
#include "dynamics/modes/modes.h"
#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

/// Mesh stiffness of a frozen position.
enum class FrozenStiffness {
  mean,        ///< mean tangent over the mesh cycle: only the directions of the bearings change with the crank
  at_position  ///< tangent at the mesh phases of the position
};

/// Stiffness of every mesh of the stage at its crank angle, N/m, in the order of the meshes.
[[nodiscard]] Eigen::VectorXd mesh_stiffness(const TwoKVStage& stage, FrozenStiffness frozen = FrozenStiffness::mean);

/// Undamped modes of the stage frozen at its crank angle, see modes(system, ...).
[[nodiscard]] Modes modes(const TwoKVStage& stage, FrozenStiffness frozen = FrozenStiffness::mean);
[[nodiscard]] ModalEnergy modal_energy(const TwoKVStage& stage, const Modes& modes,
                                       FrozenStiffness frozen = FrozenStiffness::mean);
/// Name of a mode, "body on group", or "rigid" without strain. The body (planet, crank, arc, ...) has most kinetic
/// energy, the group of elements (by_group) most strain energy.
[[nodiscard]] std::string mode_name(const ModalEnergy& energy, Eigen::Index mode);

/// Modes over one turn of the crank against the carrier.
struct CrankModes {
  Eigen::VectorXd angle;                        ///< rad, Theta = 2 pi i/count
  Eigen::MatrixXd frequency;                    ///< Hz, modes x angles, rising in each column
  std::vector<Modes> modes;                     ///< per angle
  std::vector<std::vector<std::string>> names;  ///< per angle and mode, see mode_name
};
[[nodiscard]] CrankModes modes_over_crank(const TwoKVStage& stage, int count,
                                          FrozenStiffness frozen = FrozenStiffness::at_position);

/// Static torsional stiffness by condensation, over one turn of the crank. The rigid motion of the train needs no
/// energy, so the stiffness at the output with the input held is ratio^2 times the other one, at every angle.
struct TorsionalStiffness {
  Eigen::VectorXd angle;        ///< rad
  Eigen::VectorXd from_output;  ///< N m/rad, input held; the output's own support left out
  Eigen::VectorXd from_input;   ///< N m/rad, output held; the input's own support left out
  [[nodiscard]] double mean() const { return from_output.mean(); }
  /// (max - min)/mean
  [[nodiscard]] double ripple() const { return (from_output.maxCoeff() - from_output.minCoeff()) / mean(); }
};
/// Throws InputError for a count below 1, SolverError when the stiffness is not positive.
[[nodiscard]] TorsionalStiffness torsional_stiffness(const TwoKVStage& stage, int count,
                                                     FrozenStiffness frozen = FrozenStiffness::at_position);

}  // namespace annulus::dynamics
