#pragma once

#include <string>

#include "app/plan/cost_plan.h"
#include "app/scene/scene.h"

/// What a run may take. Predictions are those of the cost laws, whatever this machine did before: the same scene is
/// always planned and refused alike.
namespace annulus::app {

/// Seconds of "30s", "2min", "500ms", "1h", "2d" or "30". Throws InputError, naming the option, for anything else.
[[nodiscard]] double parse_duration(const std::string& text, const char* option = "--budget");
/// Bytes of "16GB", "800MB" or "1.5 TB" in MB. Throws InputError for anything else.
[[nodiscard]] double parse_memory(const std::string& text);

/// What a run may take at most.
struct RunLimits {
  double memory_MB = 0;  ///< of the whole process
  double seconds = 0;    ///< wall

  /// The memory of this machine, or what its control group or a limit of the address space leaves; and a week.
  [[nodiscard]] static RunLimits of_this_machine();
};

/// What is computed: the meshes alone, or the responses and studies of the scene as well.
enum class RunExtent { meshes, whole };
/// Throws SolverError, with the figures, the step behind them and the keys that would change it, when the scene is
/// predicted to take more; with quadratic elements wherever they may have to follow linear ones. Steps whose cost is
/// not known count nothing.
void check_limits(const Scene& scene, const RunLimits& limits, int threads, RunExtent extent = RunExtent::whole);

/// The best plan for a given time.
struct BudgetChoice {
  Scene scene;  ///< with the chosen accuracy
  PlanCost cost;
  std::string sentence;  ///< what the budget gives, for people
};

/// The smallest wanted accuracy of 0.001, 0.003, 0.01, 0.03 and 0.1 whose predicted time is within the budget (s) and
/// which the finest level is expected to reach. A scene none of whose meshes refines keeps its accuracy. Throws
/// SolverError with the predicted figures when not even the cheapest plan fits.
[[nodiscard]] BudgetChoice fit_budget(const Scene& scene, double budget, int threads);

}  // namespace annulus::app
