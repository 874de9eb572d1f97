#pragma once

#include <string>

#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

struct IntegratorChoice {
  Integrator method = Integrator::arkode_explicit;
  std::string reason;         ///< one sentence with its numbers
  double stability_step = 0;  ///< s, largest stable step of the explicit method; infinity when nothing limits it
  double implicit_step = 0;   ///< s, step of BDF at this accuracy
  double explicit_steps = 0;  ///< per mesh cycle, that keep the explicit method stable; at least 1
  double least_damping = 0;   ///< least damping ratio among the motions too fast for `implicit_step`; 1 if none
};

/// Chooses the explicit Cash-Karp method, BDF or the L-stable Runge-Kutta method.
///
/// The eigenvalues of the system at mean mesh stiffness give the largest stable step of the explicit method. BDF needs
/// about 75 (1e-4/tolerance)^(1/8) steps per mesh cycle for its accuracy, measured on the stage of [HuFangXuShen2021].
/// Each costs about two explicit steps.
///
/// BDF is chosen when stability needs more than twice its steps and all faster motions are well damped. Lightly damped
/// fast motions must be followed by either method, and BDF is unstable or slow there. The L-stable method is chosen
/// where mesh cycles are so long that such motions die out within a small part of them.
///
/// Throws InputError when a stiffness divided by a mass overflows, SolverError when the eigenvalue solver fails.
[[nodiscard]] IntegratorChoice choose_integrator(const LumpedSystem& system, double relative_tolerance);

/// Throws InputError where the classical Runge-Kutta method with this fixed step (s) is unstable at mean mesh
/// stiffness.
void check_fixed_step(const LumpedSystem& system, double mesh_frequency, double step);

}  // namespace annulus::dynamics
