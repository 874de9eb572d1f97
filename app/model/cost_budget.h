#pragma once

#include <string>

#include "app/plan/cost_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// Seconds of "30s", "2min", "500ms", "1h", "2d" or "30". Throws InputError, naming the option, for anything else.
[[nodiscard]] double parse_duration(const std::string& text, const char* option = "--budget");

/// The best plan for a given time.
struct BudgetChoice {
  Scene scene;  ///< with the chosen accuracy
  PlanCost cost;
  std::string sentence;  ///< what the budget buys, for people
};

/// The smallest wanted accuracy of 0.001, 0.003, 0.01, 0.03 and 0.1 whose predicted time is within the budget (s) and
/// which the finest level is expected to reach. A scene none of whose meshes refines keeps its accuracy. Throws
/// SolverError with the predicted figures when not even the cheapest plan fits, and when the cost of a step is not
/// known.
[[nodiscard]] BudgetChoice fit_budget(const Scene& scene, double budget, int threads, const CostModel& costs);

}  // namespace annulus::app
