#pragma once

#include <optional>
#include <vector>

#include "core/figure.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/spatial/space_motion.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/helical_pair/helical_pair.h"

namespace annulus::dynamics {

/// Largest magnitudes over time and both gears, m/s^2, from the equations of motion (nothing is differenced).
struct PairAccelerations {
  Figure line_of_action;  ///< y''
  Figure axial;           ///< z''
  Figure rotation;        ///< r theta''
  /// Acceleration of the teeth in mesh, |(u'' + y'', z'')| of the pinion and |(u'' - y'', z'')| of the wheel: the
  /// signal of a sensor on the rim without the centripetal part. [LiuZhangZhangWangWang2020] does not state which
  /// acceleration its figure 4 shows; this one is compared with it.
  Figure tooth;
};

/// A motion over the window, m.
struct MotionFigures {
  Figure mean, peak_to_peak;
  Figure largest;  ///< magnitude, the mean included
};

/// Motions that free rotation of both gears does not change. They are zero where the loaded flanks just touch (half the
/// backlash taken off), and without a torque in the middle of the backlash.
struct PairMotions {
  MotionFigures transmission_error;  ///< u_1 + u_2: lag of the wheel behind the pinion, at the base circles
  MotionFigures relative;  ///< y_1 + u_1 - y_2 + u_2 [LiuZhangZhangWangWang2020, eq. (10)]: with shafts and bearings
};

/// Where contact is lost, the damper force on the separating teeth acts up to the last instant and then ends in a jump.
/// force_min, unlike force_max, then depends on the times of the samples, which its error does not contain.
struct PairResponse : SteadyOutcome {
  double mesh_frequency = 0;    ///< Hz
  double static_force = 0;      ///< N, T_1/(r_1 cos b)
  Figure force_max, force_min;  ///< N
  double force_mean = 0;        ///< N
  Figure dynamic_factor;        ///< K_V, see BranchResult
  Figure peak_factor;           ///< largest F / static force; NaN without a torque
  Figure contact_loss;          ///< fraction of the time without contact
  PairAccelerations acceleration;
  PairMotions dynamic;
  PairMotions quasi_static;  ///< without inertia, damping and speed; no errors are estimated
  std::vector<ShaftResult> shafts;
  TimeSeries series;  ///< with `keep_series`
};

/// Steady state of the pair and its results. The error of a result is the sum of the sampling error, the difference to
/// the harmonic balance or the window before, and the difference to a looser integration (to half of the fixed steps).
/// Where the harmonic balance stands alone, its largest force difference to half the samples replaces the latter. It is
/// divided by the accelerated mass, or multiplied by the static compliance of the motion.
///
/// options.confirm = false is meant for grids. While contact is never lost, the harmonic balance is then taken as it
/// is, over two periods or `min_window_cycles` if less. With loss of contact several motions may exist, and time
/// integration decides. Throws InputError without speed, or without torques and errors, and what `steady_response`
/// throws.
[[nodiscard]] PairResponse evaluate_pair(const HelicalPair& pair, const SimulationOptions& options = {});
/// The system that it solves. Throws InputError without speed, or without torques and errors.
[[nodiscard]] LumpedCase lumped_case(const HelicalPair& pair);

/// What bearings and the mesh of a pair in space do over time; empty of others. `series` must belong to the pair.
[[nodiscard]] SpaceMotion space_motion(const HelicalPair& pair, const TimeSeries& series);

/// The pair with a single cause of vibration: its errors at constant mean stiffness, or its stiffness without
/// manufacturing errors (the unloaded error of a table stays); both without ripples of the rotors.
[[nodiscard]] HelicalPair with_errors_alone(HelicalPair pair);
[[nodiscard]] HelicalPair with_stiffness_alone(HelicalPair pair);

/// Peak-to-peak transmission error u_1 + u_2, m.
struct PeakToPeak {
  double dynamic = 0, quasi_static = 0;
};

/// Contributions to the transmission error.
struct TransmissionErrorShares {
  PeakToPeak all;
  PeakToPeak errors_alone, stiffness_alone;  ///< with_errors_alone, with_stiffness_alone
  double load_deflection = 0;                ///< m, mean of the quasi-static u_1 + u_2: deflection under the load

  /// Contribution of the errors: errors alone / all. Both contributions need not add up to 1, because they have phases.
  [[nodiscard]] PeakToPeak error_share() const {
    return {errors_alone.dynamic / all.dynamic, errors_alone.quasi_static / all.quasi_static};
  }
};

/// Three responses. Throws what evaluate_pair throws.
[[nodiscard]] TransmissionErrorShares transmission_error_shares(const HelicalPair& pair,
                                                                const SimulationOptions& options = {});

}  // namespace annulus::dynamics
