#pragma once

#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// What shooting found.
struct ShootingResult {
  SystemState start;  ///< at time 0, on the periodic orbit
  bool converged = false;
  double residual = 0;  ///< largest |q(T) - q(0)| over the DOFs, m (velocities: times 1/rate)
  int iterations = 0;
  /// Floquet multipliers of one period, largest first: how motions near the orbit grow (above 1) or die.
  Eigen::VectorXcd multipliers;
};

struct ShootingOptions {
  double tolerance = 1e-9;  ///< m, for the residual
  double displacement = 0;  ///< m, > 0: size of the disturbances the multipliers are taken from
  double rate = 0;          ///< rad/s, > 0: a velocity counts like a displacement at this rate
  int max_iterations = 6;
  IntegratorOptions integrator;  ///< with an absolute tolerance
};

/// Periodic orbit of a system whose excitation and mesh vectors repeat after `period` (s): the state y with P(y) = y, P
/// the integration over one period, by Newton's method from `guess` (time 0) with dP/dy from one integration per state.
/// P is linear while no contact changes: one step then does it, however slowly the motions die that a march would have
/// to wait for. A rigid motion is left as in the guess. Not converged: the last iterate. Throws SolverError when the
/// integrator fails.
[[nodiscard]] ShootingResult shoot(const LumpedSystem& system, double period, const SystemState& guess,
                                   const ShootingOptions& options);

}  // namespace annulus::dynamics
