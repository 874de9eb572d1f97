#include "app/model/run_limits.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <utility>

#include "app/model/gear_system.h"
#include "app/process/system_limits.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "fem/cost_size.h"

namespace annulus::app {

namespace {

constexpr double week = 7 * 24 * 3600.0;
constexpr double bytes_per_MB = 1e6;

using Units = std::initializer_list<std::pair<const char*, double>>;

/// An amount above zero with one of these units, blanks between them allowed; nothing for any other text.
std::optional<double> parse_amount(const std::string& text, Units units) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value) || value <= 0) return std::nullopt;
  std::string unit(end, text.data() + text.size());
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  for (const auto& [name, factor] : units)
    if (unit == name) return value * factor;
  return std::nullopt;
}

/// The limit that a control group sets, if any; MB.
double group_memory_MB() {
  double least = std::numeric_limits<double>::infinity();
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    double bytes = 0;
    if (std::ifstream(file) >> bytes && bytes > 0) least = std::min(least, bytes / bytes_per_MB);
  }
  return least;
}

/// MB. All points of a study are stored until its report is written; a search stores its best ones only.
double memory_of(const Scene& scene, const CostStep& step) {
  if (step.kind != CostKind::studies) return step.predicted.peak_MB;
  if (step.label == "[optimise]") return 0;
  constexpr double of_a_point = 200;  // bytes besides its figures: vectors, a text
  const auto figures = static_cast<double>(system_kind(scene.stage.kind).model_figures().size());
  return step.size.unknowns * (of_a_point + figures * sizeof(double)) / bytes_per_MB;
}

/// Whether the accuracy decides how a mesh is solved.
bool refines(const MeshModel& model) { return model.has_elements() && !model.settings.level; }

/// Whether the scene's meshes are expected to reach its accuracy.
bool within_reach(const Scene& scene) {
  const auto meshes = make_system(scene)->meshes();
  return std::all_of(meshes.begin(), meshes.end(), [&](const MeshModel& model) {
    return !refines(model) || expected_error(work_of(model), model.settings.degree,
                                             fem::last_level(model.settings.fidelity)) <= scene.accuracy;
  });
}

std::string figures_text(const PlanCost& cost) {
  return fmt::format("{} and {}", duration_text(cost.seconds()), memory_text(cost.peak_MB()));
}

}  // namespace

double parse_duration(const std::string& text, const char* option) {
  if (const auto seconds =
          parse_amount(text, {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}, {"d", 86400}}))
    return *seconds;
  throw InputError(fmt::format("{} {}: is not a time above zero; write 30s, 2min, 500ms, 1h or 2d", option, text));
}

double parse_memory(const std::string& text) {
  if (const auto MB = parse_amount(text, {{"MB", 1}, {"GB", 1e3}, {"TB", 1e6}})) return *MB;
  throw InputError(
      fmt::format("--max-memory {}: is not an amount of memory above zero; write 800MB, 16GB or 1TB", text));
}

RunLimits RunLimits::of_this_machine() {
  const double physical =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / bytes_per_MB;
  return {std::min({physical, group_memory_MB(), free_address_space_MB()}), week};
}

void check_limits(const Scene& scene, const RunLimits& limits, int threads, RunExtent extent) {
  const auto cost = make_system(scene)->cost(threads).at_worst();
  double seconds = 0, longest_s = 0, largest_MB = 0;
  const CostStep *longest = nullptr, *largest = nullptr;
  for (const auto& step : cost.steps) {
    const bool dynamics = step.kind == CostKind::response || step.kind == CostKind::studies;
    if (dynamics && extent == RunExtent::meshes) continue;
    const double time = step.predicted.seconds, memory = memory_of(scene, step);
    if (std::isfinite(time)) seconds += time;
    if (std::isfinite(time) && time > longest_s) longest = &step, longest_s = time;
    if (memory > largest_MB) largest = &step, largest_MB = memory;
  }
  const auto at_worst = [](const CostStep& step) { return step.further ? " if " + step.follow : std::string(); };
  if (largest_MB > limits.memory_MB)
    throw SolverError(
        fmt::format("{}: refused: predicted to need {} of memory{}, the limit is {} (--max-memory). The largest part "
                    "is for the {}: {}",
                    scene.file.string(), memory_text(largest_MB), at_worst(*largest), memory_text(limits.memory_MB),
                    largest->label, largest->cause));
  if (seconds > limits.seconds)
    throw SolverError(
        fmt::format("{}: refused: predicted to take {}{}, the limit is {} (--max-time). Of it, {} are for the {}: {}",
                    scene.file.string(), duration_text(seconds), at_worst(*longest), duration_text(limits.seconds),
                    duration_text(longest_s), longest->label, longest->cause));
}

BudgetChoice fit_budget(const Scene& scene, double budget, int threads) {
  constexpr double accuracy_ladder[] = {0.001, 0.003, 0.01, 0.03, 0.1};
  const std::string given = duration_text(budget);
  // Formulas that do for the scene's own accuracy may not for a finer one.
  const auto finest = make_system(with_accuracy(scene, accuracy_ladder[0], ""))->meshes();
  if (std::none_of(finest.begin(), finest.end(), refines)) {
    auto cost = make_system(scene)->cost(threads);
    if (cost.seconds() > budget)
      throw SolverError(fmt::format(
          "the run is predicted to take {}, more than the budget of {}, and its accuracy refines none of its meshes",
          figures_text(cost), given));
    auto sentence =
        fmt::format("budget {}: predicted {}; no mesh of this scene is refined, and its accuracy is unchanged", given,
                    figures_text(cost));
    return {scene, std::move(cost), std::move(sentence)};
  }
  // Not always the coarsest: with fewer loads in its tables a study may need more of them.
  PlanCost cheapest;
  double cheapest_accuracy = 0;
  for (const double accuracy : accuracy_ladder) {
    auto fitted = with_accuracy(scene, accuracy, fmt::format("the most accurate that fits into a budget of {}", given));
    if (!within_reach(fitted)) continue;
    auto cost = make_system(fitted)->cost(threads);
    if (cost.seconds() > budget) {
      if (cheapest.empty() || cost.seconds() <= cheapest.seconds()) cheapest = cost, cheapest_accuracy = accuracy;
      continue;
    }
    auto sentence = fmt::format(
        "budget {}: gives a mesh stiffness within {:g} % of its model (expected error {:.2g} %); predicted {}; --set "
        "accuracy={} repeats it",
        given, 100 * accuracy, 100 * cost.expected_error(), figures_text(cost), to_text(accuracy));
    return {std::move(fitted), std::move(cost), std::move(sentence)};
  }
  require(!cheapest.empty(), "no accuracy is within reach of the finest level");
  throw SolverError(fmt::format(
      "the cheapest plan, a mesh stiffness within {:g} %, is predicted to take {}: more than the budget of {}",
      100 * cheapest_accuracy, figures_text(cheapest), given));
}

}  // namespace annulus::app
