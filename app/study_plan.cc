#include "app/study_plan.h"

#include <fmt/format.h>

#include "app/stage_kinds.h"
#include "app/study_cases.h"

namespace annulus::app {

namespace {

int count_tables(const Scene& scene, const std::vector<StudyCase>& cases) {
  std::size_t tables = 0;
  for (const auto& study_case : cases) tables += tables_to_solve(scene, change_scene(scene, study_case)).size();
  return static_cast<int>(tables);
}

std::string row_text(const Scene& scene, const SweepInput& s) {
  const auto values = s.points();
  return fmt::format("{} from {} to {} {}, {} values", s.input, to_text(values.front()), to_text(values.back()),
                     find_input(scene, s.input).parameter->unit, values.size());
}

}  // namespace

std::vector<StudyPlan> plan_studies(const Scene& scene) {
  std::vector<StudyPlan> list;
  const bool any = !scene.sweeps.empty() || !scene.grids.empty() || scene.monte_carlo || scene.sensitivity;
  if (!any || !scene.dynamics) return list;
  const auto variants = static_cast<long>(variant_count(scene));
  const double each = response_seconds(scene);
  const auto add = [&](std::string name, std::string what, std::size_t cases, int tables) {
    const auto n = static_cast<long>(cases);
    list.push_back({std::move(name), std::move(what), n * variants, tables, each * static_cast<double>(n)});
  };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i) {
    const auto cases = sweep_cases(scene, i);
    add(fmt::format("[[sweep]] {}", i + 1), row_text(scene, scene.sweeps[i]), cases.size(), count_tables(scene, cases));
  }
  for (std::size_t i = 0; i < scene.grids.size(); ++i) {
    const auto cases = grid_cases(scene, i);
    add(fmt::format("[[grid]] {}", i + 1), row_text(scene, scene.grids[i].x) + "; " + row_text(scene, scene.grids[i].y),
        cases.size(), count_tables(scene, cases));
  }
  if (scene.monte_carlo)
    add("[monte_carlo]",
        fmt::format("{} samples of {} random inputs, seed {}", scene.monte_carlo->samples,
                    random_variables(scene).size(), scene.monte_carlo->seed),
        static_cast<std::size_t>(scene.monte_carlo->samples), 0);
  if (scene.sensitivity) {
    const auto cases = sensitivity_cases(scene);
    add("[sensitivity]",
        fmt::format("{} inputs, each divided and multiplied by {}", cases.size() / 2,
                    to_text(scene.sensitivity->factor)),
        cases.size() + 1, count_tables(scene, cases));
  }
  return list;
}

}  // namespace annulus::app
