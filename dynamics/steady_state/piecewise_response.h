#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/steady_state/periodic_response.h"

namespace annulus::dynamics {

struct PiecewiseOptions {
  int samples_per_cycle = 32;
  bool motion = true;  ///< also the displacements and velocities of all DOFs
};

/// Exact periodic response of a system whose stiffnesses are constant between known jumps.
struct PiecewiseResponse {
  /// `converged`: the system is of the kind (else `trouble` says why not), the solution exists, is stable and every
  /// mesh stays closed. `residual`: of the periodic state, relative; no coarse forces.
  PeriodicResponse periodic;
  bool solved = false;          ///< the figures below are there
  bool stable = false;          ///< no Floquet multiplier lies outside the unit circle
  double largest_multiplier{};  ///< modulus, over `solved_cycles` mesh cycles; neutral rigid motions left out
  int solved_cycles = 0;        ///< period of the excitation; the samples repeat after it
  /// Least deflection beyond half backlash over all meshes and times, m (infinite without backlash). Not above zero:
  /// teeth part, and the response is not this one.
  double least_penetration = 0;
  int least_mesh = -1;  ///< the mesh it belongs to, -1 without backlash
  /// Jumps within `solved_cycles` and the mesh forces on both sides of each: where a stiffness jumps, so do force and
  /// load sharing, and extremes stand there. meshes x jumps, N.
  /// (The beginning of the period counts as a jump.)
  Eigen::VectorXd jump_time;
  Eigen::MatrixXd force_before, force_after;
  /// Forces over `solved_cycles` close enough together for every peak: the highest modes are not seen at the samples
  /// asked for. Equidistant, meshes x times; and the samples at or right behind a jump.
  Eigen::MatrixXd dense_force;
  std::vector<Eigen::Index> dense_after_jump;
};

/// Why the system is not one for piecewise_response; empty when it is: constant or rectangular stiffnesses that repeat
/// with the period, no law, no coupling, no moving mesh vector, errors constant or harmonic.
[[nodiscard]] std::string why_not_piecewise(const LumpedSystem& system, double period);

/// Would the exact solution of such a system have too many points, of a motion far faster than the period?
[[nodiscard]] bool too_fast_for_piecewise(const LumpedSystem& system, double period, int cycles);

/// While no mesh separates and between two jumps the system is linear with constant coefficients, y' = A y + B a(t),
/// with a = (1, sin, cos of the error rates), itself the solution of a linear system: the state over a piece is a
/// matrix exponential. The periodic state solves (I - Phi) y0 = c, Phi the product of the pieces (monodromy matrix),
/// whose eigenvalues (Floquet multipliers) tell the stability. No discretisation: accurate to rounding. Teeth are taken
/// as closed on the drive flank all the time; `least_penetration` (cubic interpolation between steps of a quarter
/// radian of the fastest mode) tells whether they are.
///
/// `period` (s) spans `cycles` mesh cycles. Rigid motions are fixed by nu^T M q = 0 in the mean over the samples.
/// Throws InputError when the load is not balanced.
[[nodiscard]] PiecewiseResponse piecewise_response(const LumpedSystem& system, double period, int cycles,
                                                   const PiecewiseOptions& options = {});

}  // namespace annulus::dynamics
