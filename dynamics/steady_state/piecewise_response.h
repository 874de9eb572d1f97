#pragma once

#include <string>

#include "dynamics/steady_state/periodic_response.h"

namespace annulus::dynamics {

/// Exact periodic response of a system whose stiffnesses are constant between known jumps.
///
/// `converged`: the method applies, the solution exists and is stable, and every mesh stays in contact; `trouble`
/// states the cause otherwise. `residual`: of the periodic state, relative. `largest_multiplier`: over `solved_cycles`
/// mesh cycles, neutral rigid motions left out. There are no coarse forces. Jumps and forces at closer times are those
/// of `solved_cycles`; the closer times resolve the peaks of the highest modes.
struct PiecewiseResponse : PeriodicResponse {
  bool solved = false;    ///< the results are present
  bool stable = false;    ///< no Floquet multiplier lies outside the unit circle
  int solved_cycles = 0;  ///< period of the excitation; the samples repeat after it
  /// Least deflection beyond half backlash over all meshes and times, m (infinite without backlash). Zero or less means
  /// loss of contact, and the response is another one.
  double least_penetration = 0;
  int least_mesh = -1;  ///< its mesh, -1 without backlash
};

/// The reason why piecewise_response does not apply, or empty. It needs constant or rectangular stiffnesses that repeat
/// with `period` (s), constant or harmonic errors, no law, no coupling, no bearing with play and no moving
/// mesh vector.
[[nodiscard]] std::string why_not_piecewise(const LumpedSystem& system, double period);

/// Would the exact solution of such a system need too many points because its motion is far faster than the period (s)?
[[nodiscard]] bool too_fast_for_piecewise(const LumpedSystem& system, double period, int cycles);

/// Periodic response without discretisation, accurate to rounding.
///
/// Between two jumps, and without loss of contact, the system is linear with constant coefficients: y' = A y + B a(t).
/// a = (1, sin, cos of the error rates) solves a linear system itself, so the state over a piece follows from a matrix
/// exponential. The periodic state solves (I - Phi) y0 = c, where Phi, the product of the pieces, is the monodromy
/// matrix. Its eigenvalues are the Floquet multipliers, which decide on stability.
///
/// All teeth are assumed in contact on the drive flank. `least_penetration` verifies that, by cubic interpolation
/// between steps of a quarter radian of the fastest mode.
///
/// `period` (s) spans `cycles` mesh cycles. Rigid motions are fixed by nu^T M q = 0 in the mean over the samples.
/// Throws InputError when the period is not usable or the load is not balanced.
[[nodiscard]] PiecewiseResponse piecewise_response(const LumpedSystem& system, double period, int cycles,
                                                   int samples_per_cycle = 32);

}  // namespace annulus::dynamics
