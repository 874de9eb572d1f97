#pragma once

#include <string>

#include "app/plan/cost_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// What a run may take at most.
struct RunLimits {
  double memory_MB = 0;  ///< of the whole process
  double seconds = 0;    ///< wall

  /// The memory of this machine, or what its control group or a limit of the address space leaves; and a week.
  [[nodiscard]] static RunLimits of_this_machine();
};

/// Bytes of "16GB", "800MB" or "1.5 TB" in MB. Throws InputError for anything else.
[[nodiscard]] double parse_memory(const std::string& text);

/// Throws SolverError, with the figures, the step behind them and the keys that would change it, when the scene is
/// predicted to take more. Steps whose cost is not known count nothing.
void check_limits(const Scene& scene, const RunLimits& limits, int threads, const CostModel& costs,
                  bool with_dynamics = true);

}  // namespace annulus::app
