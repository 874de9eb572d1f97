#pragma once

#include <string>

#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

struct IntegratorChoice {
  Integrator method = Integrator::arkode_explicit;
  std::string reason;         ///< one sentence with the numbers behind it
  double stability_step = 0;  ///< s, largest stable step of the explicit method; infinity when nothing limits it
  double implicit_step = 0;   ///< s, step of BDF at this accuracy
  double explicit_steps = 0;  ///< per mesh cycle, that keep the explicit method stable; at least 1
  double least_damping = 0;   ///< least damping ratio among the motions too fast for `implicit_step`; 1 if none
};

/// Explicit Cash-Karp, BDF or the L-stable Runge-Kutta method. The eigenvalues of the system at mean mesh stiffness
/// give the step that keeps the explicit method stable; accuracy asks BDF for about 75 (1e-4/tolerance)^(1/8) steps per
/// mesh cycle (measured on the stage of the ring paper), each about twice as dear as an explicit one. BDF is chosen
/// when stability asks for more than twice its steps and all motions too fast for them are well damped: fast motions
/// that ring on have to be followed by either method, and BDF is unstable or slow there. Where mesh cycles are so long
/// that such motions die within a small part of them, the L-stable method is chosen.
[[nodiscard]] IntegratorChoice choose_integrator(const LumpedSystem& system, double relative_tolerance);

/// Throws InputError where the classical Runge-Kutta method with this fixed step (s) is unstable at mean mesh
/// stiffness.
void check_fixed_step(const LumpedSystem& system, double mesh_frequency, double step);

}  // namespace annulus::dynamics
