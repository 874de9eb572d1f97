#pragma once

#include <limits>
#include <optional>

#include "core/figure.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/helical_pair/helical_pair.h"

namespace annulus::dynamics {

/// Largest magnitudes over time and both gears, m/s^2, from the equations of motion (nothing is differenced).
struct PairAccelerations {
  Figure line_of_action;  ///< y''
  Figure axial;           ///< z''
  Figure rotation;        ///< r theta''
  /// Of the teeth in mesh, |(u'' + y'', z'')| of the pinion, |(u'' - y'', z'')| of the wheel: what a pickup on the rim
  /// would see without the centripetal part. The paper does not say which acceleration its figure 4 shows; this one is
  /// taken for it.
  Figure tooth;
};

/// A motion over the window, m.
struct MotionFigures {
  double mean = 0;
  Figure peak_to_peak;
  Figure largest;  ///< magnitude, the mean included
};

/// Turning both gears freely leaves each of these alone. Measured from where the loaded flanks just touch (half the
/// backlash taken off); without a torque from the middle of the backlash.
struct PairMotions {
  MotionFigures transmission_error;  ///< u_1 + u_2: how far the wheel lags behind the pinion, at the base circles
  MotionFigures relative;            ///< y_1 + u_1 - y_2 + u_2, (10): with the bending of shafts and bearings
};

/// Where contact is lost the damper holds the parting teeth back up to the last instant and its force then ends in a
/// jump: force_min, unlike force_max, then depends on where the samples fall, which its error does not tell.
struct PairResponse : SteadyOutcome {
  double mesh_frequency = 0;    ///< Hz
  double static_force = 0;      ///< N, T_1/(r_1 cos b)
  Figure force_max, force_min;  ///< N
  double force_mean = 0;        ///< N
  Figure dynamic_factor;        ///< largest F / static force; NaN without a torque
  double contact_loss = 0;      ///< fraction of the time without contact
  PairAccelerations acceleration;
  PairMotions dynamic;
  PairMotions quasi_static;  ///< without inertia, damping and speed; no errors are estimated
  TimeSeries series;         ///< with `keep_series`
};

/// Steady state of the pair and its figures. The error of a figure adds up what the sampling misses and the differences
/// to the harmonic balance or the window before and to a looser integration. Where the harmonic balance stands alone,
/// its largest force difference to half the samples stands for the latter, divided by the mass that it accelerates or
/// times the static compliance of the motion.
///
/// options.confirm = false is for grids: the balance then is taken as it stands while the teeth touch all the time,
/// over two periods or `min_window_cycles` if less. Where they part several motions may be possible and marching
/// decides. Throws InputError without speed, or without both torque and errors, and what `steady_response` throws.
[[nodiscard]] PairResponse evaluate_pair(const HelicalPair& pair, const SimulationOptions& options = {});

/// Peak-to-peak transmission error u_1 + u_2, m.
struct PeakToPeak {
  double dynamic = 0, quasi_static = 0;
};

/// Where the transmission error comes from.
struct TransmissionErrorShares {
  PeakToPeak all;
  PeakToPeak errors_alone;     ///< at constant mean stiffness: manufacturing errors alone
  PeakToPeak stiffness_alone;  ///< without manufacturing errors; the unloaded error of a table stays
  double load_deflection = 0;  ///< m, mean of the quasi-static u_1 + u_2: what the load bends, 0 without a torque

  /// Share of the errors in the whole range: errors alone / all. Both causes need not add up to 1: they have phases.
  [[nodiscard]] PeakToPeak error_share() const {
    return {errors_alone.dynamic / all.dynamic, errors_alone.quasi_static / all.quasi_static};
  }
};

/// Three responses. Throws what evaluate_pair throws.
[[nodiscard]] TransmissionErrorShares transmission_error_shares(const HelicalPair& pair,
                                                                const SimulationOptions& options = {});

}  // namespace annulus::dynamics
