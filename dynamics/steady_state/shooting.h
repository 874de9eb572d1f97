#pragma once

#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// Result of the shooting method.
struct ShootingResult {
  SystemState start;  ///< at time 0, on the periodic orbit
  bool converged = false;
  double residual = 0;  ///< largest |q(T) - q(0)| over the DOFs, m (velocities: times 1/rate)
  int iterations = 0;
  /// Floquet multipliers of one period, largest first. Disturbances of the orbit grow with a modulus above 1.
  Eigen::VectorXcd multipliers;
};

struct ShootingOptions {
  double tolerance = 1e-9;  ///< m, for the residual
  double displacement = 0;  ///< m, > 0: size of the disturbances that give the multipliers
  double rate = 0;          ///< rad/s, > 0: a velocity counts like a displacement at this rate
  int max_iterations = 6;
  IntegratorOptions integrator;  ///< with an absolute tolerance
};

/// Periodic orbit, by the shooting method, of a system whose excitation and mesh vectors repeat after `period` (s). It
/// is the state y with P(y) = y, where P is the integration over one period. Newton's method starts from `guess` (time
/// 0); dP/dy takes one integration per state variable.
///
/// P is linear while no contact changes. One step then suffices, even where motions die out so slowly that a time
/// integration would take very long. A rigid motion stays as in the guess. Without convergence the last iterate is
/// returned. Throws SolverError when the integrator fails.
[[nodiscard]] ShootingResult shoot(const LumpedSystem& system, double period, const SystemState& guess,
                                   const ShootingOptions& options);

}  // namespace annulus::dynamics
