#pragma once

#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// How the stiffness of a system will change once it is known.
enum class StiffnessCourse {
  smooth,
  sudden  ///< teeth come into contact and leave it, or it jumps: every time the fast motions are excited
};

/// Of the excitations of a system: tables of tooth contacts and jumps are sudden.
[[nodiscard]] StiffnessCourse stiffness_course(const LumpedSystem& system);

/// Rough time on one core (s) for the integration of `cycles` mesh cycles with the method and tolerance of the options.
/// It follows from the steps that stability or accuracy need, so slow speeds, stiff supports and tight tolerances cost
/// in proportion. Loss of contact, which restarts the integrator, is not predicted and doubles it. `mesh_frequency` in
/// Hz.
[[nodiscard]] double integration_seconds(const LumpedSystem& system, double mesh_frequency, double cycles,
                                         const IntegratorOptions& options,
                                         StiffnessCourse course = StiffnessCourse::smooth);

/// Rough time on one core (s) of one evaluation of the equations of motion.
[[nodiscard]] double evaluation_seconds(const LumpedSystem& system);

/// What steady_response will do.
struct SteadyCourse {
  double cycles = 0;           ///< mesh cycles integrated in time, those that estimate the integrator's error included
  double searched_cycles = 0;  ///< the same for other motions, were they looked for
  double reach = 0;            ///< reach_of_backlash(): they are from within_reach on
  double compared_cycles = 0;  ///< the same for each comparison with changed tables (comparison_options)
  double balance_s = 0;        ///< s, of each harmonic balance, which is the comparison where no cycles are
  int samples = 0;             ///< per mesh cycle, of the periodic motion

  /// Cycles of the search for other motions that is expected.
  [[nodiscard]] double expected_search() const { return reach >= within_reach ? searched_cycles : 0; }
  /// s that the search may take, where a cycle takes `per_cycle` (s): where the reach is within a factor of four of
  /// what is enough it may be needed, beyond that starts may remain undecided to the end.
  [[nodiscard]] double possible_search_s(double per_cycle) const;
};
/// Rough prediction for a motion that repeats after `period` mesh cycles. A harmonic balance is confirmed by one window
/// where its samples suffice, which long periods do not allow: then windows are integrated until two agree, as they are
/// for mesh vectors that move. Nearly undamped motions take more, up to `max_windows`.
[[nodiscard]] SteadyCourse steady_course(const LumpedSystem& system, double mesh_frequency, int period,
                                         const SimulationOptions& options,
                                         StiffnessCourse course = StiffnessCourse::smooth);

}  // namespace annulus::dynamics
