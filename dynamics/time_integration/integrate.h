#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/pacing.h"

namespace annulus::dynamics {

/// Methods of time integration, from SUNDIALS [HindmarshEtAl2005].
///
/// Measured on the stage of [HuFangXuShen2021] with 64 samples per mesh cycle and tolerances from 1e-4 to 1e-8:
/// Cash-Karp takes 15 % less time than Dormand-Prince for the same error. Verner 6(5) and Fehlberg 8(7) take two to
/// five times as much.
enum class Integrator {
  automatic,        ///< arkode_explicit, arkode_implicit or cvode_bdf, see choose_integrator
  arkode_explicit,  ///< ARKODE ERKStep, Cash-Karp 5(4) [CashKarp1990], adaptive: the fastest for gear sets of metal
  cvode_adams,      ///< CVODE Adams-Moulton with fixed-point iteration
  cvode_bdf,        ///< CVODE BDF with Newton iteration and analytic Jacobian: for stiff, well damped systems
  runge_kutta_4,    ///< classical Runge-Kutta with a fixed step, as in the papers; needs `fixed_step`
  arkode_implicit,  ///< ARKODE ARKStep, ESDIRK 5(4), L-stable: for slow motions of lightly damped systems
};

struct IntegratorOptions {
  Integrator method = Integrator::automatic;
  double relative_tolerance = 1e-6;
  /// m. Absent: relative_tolerance times the mesh deflection under the mean force is resolved to a tenth.
  std::optional<double> absolute_tolerance;
  double fixed_step = 0;        ///< s, runge_kutta_4 only
  long max_steps = 50'000'000;  ///< per ten thousand mesh cycles; a guard against a tolerance out of reach
};

struct IntegratorStatistics {
  long steps = 0;
  long rhs_evaluations = 0;
  long jacobian_evaluations = 0;
  long contact_events = 0;      ///< losses of contact and returns to it
  long stiffness_restarts = 0;  ///< jumps of a rectangular stiffness, points of a course
};

/// State of a system and its energies since the start of an integration.
struct SystemState {
  double time = 0;                      ///< s
  Eigen::VectorXd q, v;                 ///< m and m/s, one entry per DOF
  double supplied = 0, dissipated = 0;  ///< J since the start, with EnergyTracking::on
};

enum class EnergyTracking { off, on };

/// Everything an integration reports on its way. Functions may be empty. The mesh forces in the workspace are evaluated
/// before each call.
struct IntegrationObserver {
  int samples = 0;  ///< number of times at which `sample` is called, index = 0 ... samples - 1
  /// s, rising from the start on, below the end; absent: state.time + index (end - state.time)/samples.
  std::function<double(int index)> time_of{};
  std::function<void(int index, const SystemState&)> sample{};
  /// Called with the time (s) before and after every jump of a stiffness. In a system with jumps it is called at the
  /// end of the integration as well, where a jump may stand.
  std::function<void(double time)> at_jump{};
  EnergyTracking energy = EnergyTracking::off;  ///< on: SystemState::supplied and dissipated are integrated too
};

/// Integrates from `state` to the time `end` (s) and leaves the state there.
///
/// Contact events, |delta| = half backlash, are located as roots. The integrator restarts there and at the known jumps
/// of rectangular stiffnesses.
///
/// `pacing`: a course that the system follows; energies are then not tracked. Null: as the system was built.
///
/// Throws InputError for unusable options or an end that is not after the start. Throws SolverError, with time and
/// cause, when the integrator fails or a value is not finite.
IntegratorStatistics integrate(const LumpedSystem& system, SystemState& state, double end,
                               const IntegratorOptions& options, LumpedSystem::Workspace& workspace,
                               const IntegrationObserver& observer = {}, const Pacing* pacing = nullptr);

}  // namespace annulus::dynamics
