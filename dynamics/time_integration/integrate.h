#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Measured on the ring paper's stage, 64 samples a cycle: at tolerances from 1e-4 to 1e-8 Cash-Karp takes 15 % less
/// time than Dormand-Prince for the same error; Verner 6(5) and Fehlberg 8(7) take two to five times as much.
enum class Integrator {
  automatic,        ///< arkode_explicit, arkode_implicit or cvode_bdf, see choose_integrator
  arkode_explicit,  ///< ARKODE ERKStep, Cash-Karp 5(4), adaptive: the fastest for gear sets of metal
  cvode_adams,      ///< CVODE Adams-Moulton with fixed-point iteration
  cvode_bdf,        ///< CVODE BDF with Newton and analytic Jacobian: for stiff, well damped systems
  runge_kutta_4,    ///< fixed step classical Runge-Kutta, as in the papers; needs `fixed_step`
  arkode_implicit,  ///< ARKODE ARKStep, ESDIRK 5(4), L-stable: for slow motions of lightly damped systems
};

struct IntegratorOptions {
  Integrator method = Integrator::automatic;
  double relative_tolerance = 1e-6;
  /// m. Absent: relative_tolerance times the mesh deflection under the mean force is resolved to a tenth.
  std::optional<double> absolute_tolerance;
  double fixed_step = 0;        ///< s, runge_kutta_4 only
  long max_steps = 50'000'000;  ///< per ten thousand mesh cycles; a guard against a hopeless tolerance
};

struct IntegratorStatistics {
  long steps = 0;
  long rhs_evaluations = 0;
  long jacobian_evaluations = 0;
  long contact_events = 0;      ///< times a mesh opened or closed
  long stiffness_restarts = 0;  ///< times a rectangular stiffness jumped
};

/// State and energy bookkeeping of an integration.
struct SystemState {
  double time = 0;                      ///< s
  Eigen::VectorXd q, v;                 ///< m, m/s
  double supplied = 0, dissipated = 0;  ///< J since the start, when tracked
};

/// Integrates from `state` to time `end` and leaves the state there. `sample` (may be empty) is called at the
/// `samples` equidistant times state.time + i (end - state.time)/samples, i = 0 ... samples-1, after the mesh forces in
/// `workspace` have been evaluated there.
/// Roots of |delta| = half backlash and the known jumps of rectangular stiffnesses are located and the integrator
/// restarts there. Throws SolverError naming time and cause when the integrator fails or a value is not finite.
/// `at_jump` (may be empty) is called, with the time, before and after every jump of a stiffness and, in a system with
/// jumps, at the end of the integration (a jump may stand there), the mesh forces evaluated each time.
IntegratorStatistics integrate(const LumpedSystem& system, SystemState& state, double end,
                               const IntegratorOptions& options, LumpedSystem::Workspace& workspace, int samples = 0,
                               const std::function<void(int index, const SystemState&)>& sample = {},
                               bool track_energy = false, const std::function<void(double time)>& at_jump = {});

}  // namespace annulus::dynamics
