#pragma once

#include <optional>
#include <string>

#include "dynamics/steady_state/response_window.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// A periodic solution over one evaluated window from time 0.
struct PeriodicWindows {
  ResponseWindow fine;
  /// Harmonic balance alone: the forces found with half the samples, or one iteration with more of them, whichever
  /// differ more.
  std::optional<ResponseWindow> compared;
};

enum class PeriodicStatus {
  not_tried,  ///< time integration alone was asked for, or the window holds no whole period
  not_found,  ///< no convergence, or the exact solution loses contact or is unstable
  unstable,   ///< found, but disturbances of it grow
  found
};

/// A periodic solution, without any time integration.
struct PeriodicSearch {
  PeriodicSearch() = default;
  explicit PeriodicSearch(const PeriodicSolution& solution)
      : status(solution.converged ? PeriodicStatus::found : PeriodicStatus::not_found), report(solution) {}

  PeriodicStatus status = PeriodicStatus::not_tried;
  std::optional<PeriodicSolution> report;  ///< absent when not tried
  std::optional<PeriodicWindows> windows;  ///< present when found

  /// Does any mesh lose contact in the solution that was found?
  [[nodiscard]] bool loses_contact() const;
};

/// Searches for the periodic solution over `cycles` mesh cycles, whole periods of the problem. Systems with jumps of
/// constant stiffnesses are solved exactly, all others by harmonic balance. Its stability is examined where it is
/// always confirmed.
[[nodiscard]] PeriodicSearch find_periodic_solution(const LumpedSystem& system, const SteadyProblem& problem,
                                                    int cycles, const SimulationOptions& options);

/// Limit of the samples of a harmonic balance over `period` mesh cycles.
[[nodiscard]] int most_samples_per_cycle(int period);

}  // namespace annulus::dynamics
