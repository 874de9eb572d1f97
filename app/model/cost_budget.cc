#include "app/model/cost_budget.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "app/model/gear_system.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "fem/cost_size.h"

namespace annulus::app {

namespace {

constexpr double accuracy_ladder[] = {0.001, 0.003, 0.01, 0.03, 0.1};

/// Whether the accuracy decides how a mesh is solved.
bool refines(const MeshModel& model) {
  return model.computed() && model.settings.fidelity != fem::Fidelity::closed_form && !model.settings.level;
}

/// Whether the scene's meshes are expected to reach its accuracy.
bool within_reach(const Scene& scene, const CostModel& costs) {
  for (const auto& model : make_system(scene)->meshes()) {
    if (refines(model) && costs.expected_error(cost_kind(model), model.settings.degree,
                                               fem::last_level(model.settings.fidelity)) > scene.accuracy)
      return false;
  }
  return true;
}

std::string figures_text(const PlanCost& cost) {
  return fmt::format("{} and {}", duration_text(cost.seconds()), memory_text(cost.peak_MB()));
}

}  // namespace

double parse_duration(const std::string& text, const char* option) {
  static constexpr std::pair<const char*, double> time_units[] = {{"", 1},     {"s", 1},    {"ms", 1e-3},
                                                                  {"min", 60}, {"h", 3600}, {"d", 86400}};
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && std::isfinite(value) && value > 0) {
    std::string unit(end, text.data() + text.size());
    unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size() : unit.find_first_not_of(' '));
    for (const auto& [name, seconds] : time_units)
      if (unit == name) return value * seconds;
  }
  throw InputError(fmt::format("{} {}: is not a time above zero; write 30s, 2min, 500ms, 1h or 2d", option, text));
}

BudgetChoice fit_budget(const Scene& scene, double budget, int threads, const CostModel& costs) {
  bool any = false;
  // Formulas that do for the scene's own accuracy may not for a finer one.
  for (const auto& model : make_system(with_accuracy(scene, accuracy_ladder[0], ""))->meshes())
    any = any || refines(model);
  const auto known = [](const PlanCost& cost) {
    if (std::isfinite(cost.seconds())) return;
    for (const auto& step : cost.steps)
      if (!std::isfinite(step.predicted.seconds))
        throw SolverError(fmt::format("--budget: what the {} costs ({}) is not known; run it without a budget",
                                      step.label, step.size.kind));
  };
  PlanCost cost = make_system(scene)->cost(threads, costs);
  known(cost);
  if (!any) {
    if (cost.seconds() > budget)
      throw SolverError(
          fmt::format("the run is predicted to take {}, more than the budget of {}, and none of its "
                      "meshes is refined by its accuracy",
                      figures_text(cost), duration_text(budget)));
    return {scene, cost,
            fmt::format("budget {}: predicted {}; no mesh of this scene is refined, its accuracy stays as it is",
                        duration_text(budget), figures_text(cost))};
  }
  // Not always the coarsest: with fewer loads in its tables a study may need more of them.
  PlanCost cheapest;
  double cheapest_accuracy = 0;
  for (const double accuracy : accuracy_ladder) {
    Scene fitted = with_accuracy(scene, accuracy,
                                 fmt::format("the most accurate that a budget of {} pays for", duration_text(budget)));
    if (!within_reach(fitted, costs)) continue;
    cost = make_system(fitted)->cost(threads, costs);
    known(cost);
    if (cost.seconds() > budget) {
      if (cheapest.empty() || cost.seconds() <= cheapest.seconds()) cheapest = cost, cheapest_accuracy = accuracy;
      continue;
    }
    auto sentence = fmt::format(
        "budget {}: buys a mesh stiffness within {:g} % of its model (expected error {:.2g} %); predicted {}",
        duration_text(budget), 100 * accuracy, 100 * cost.expected_error(), figures_text(cost));
    return {std::move(fitted), std::move(cost), std::move(sentence)};
  }
  require(!cheapest.empty(), "no accuracy is within reach of the finest level");
  throw SolverError(fmt::format(
      "the cheapest plan, a mesh stiffness within {:g} %, is predicted to take {}: more than the budget of {}",
      100 * cheapest_accuracy, figures_text(cheapest), duration_text(budget)));
}

}  // namespace annulus::app
