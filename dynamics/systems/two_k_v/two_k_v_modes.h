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

/// Undamped modes of the stage frozen at its crank angle, with the mean stiffness of its meshes.
[[nodiscard]] Modes modes(const TwoKVStage& stage);
[[nodiscard]] ModalEnergy modal_energy(const TwoKVStage& stage, const Modes& modes);

/// Positions over one turn of the crank: eight per mesh cycle where the mesh stiffness changes.
[[nodiscard]] int crank_positions(const TwoKVStage& stage);

/// Modes over one turn of the crank against the carrier.
struct CrankModes {
  Eigen::VectorXd angle;      ///< rad, Theta = 2 pi i/count
  Eigen::MatrixXd frequency;  ///< Hz, modes x angles, rising in each column
  std::vector<Modes> modes;   ///< per angle; shapes go on from the angle before, without changes of sign
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

/// No mesh changes its stiffness: nothing but the directions of the eccentrics turns, and that excites nothing.
[[nodiscard]] bool constant_stiffness(const TwoKVStage& stage);

/// The reducer as one mass on one spring, seen from the output held still: the bodies turn as the train without
/// deformation, against the static torsional stiffness.
struct OneDof {
  double stiffness = 0;        ///< N m/rad
  double input_inertia = 0;    ///< kg m^2, input alone, times ratio^2
  double train_inertia = 0;    ///< kg m^2, all bodies but the output
  double input_frequency = 0;  ///< Hz, of the input alone
  double train_frequency = 0;  ///< Hz
};
[[nodiscard]] OneDof one_dof(const TwoKVStage& stage);

/// Turn of the output with the input held, rad.
struct LostMotion {
  double backlash = 0;  ///< between the flanks, without torque
  double elastic = 0;   ///< between -3 % and +3 % of the torque, as robot reducers are tested
  double wind_up = 0;   ///< under the torque
  [[nodiscard]] double total() const { return backlash + elastic; }
};
/// `arc_clearance`: m, taken off the arc flanks along their normal.
[[nodiscard]] LostMotion lost_motion(const TwoKVStage& stage, double stiffness, double arc_clearance);

}  // namespace annulus::dynamics
