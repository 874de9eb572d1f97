#pragma once

#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

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
