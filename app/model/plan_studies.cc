#include "app/model/plan_studies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/model/gear_system.h"
#include "app/model/study_cases.h"
#include "core/errors.h"

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
                     unit_of_input(scene, s.input), values.size());
}

}  // namespace

std::vector<StudyPlan> plan_studies(const Scene& scene) {
  std::vector<StudyPlan> list;
  const auto sampling = sampling_of(scene);
  const bool any = !scene.sweeps.empty() || !scene.grids.empty() || sampling || scene.sensitivity || scene.optimise;
  if (!any || !scene.dynamics) return list;
  const auto variants = static_cast<long>(make_system(scene)->variants().size());
  const double each = make_system(scene)->response_seconds();
  const auto add = [&](std::string name, std::string what, std::size_t cases, int tables) {
    const auto n = static_cast<long>(cases);
    list.push_back({std::move(name), std::move(what), n * variants, tables, each * static_cast<double>(n)});
  };
  const auto add_cases = [&](std::string name, std::string what, const std::vector<StudyCase>& cases) {
    add(std::move(name), std::move(what), cases.size(), count_tables(scene, cases));
  };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i)
    add_cases(fmt::format("[[sweep]] {}", i + 1), row_text(scene, scene.sweeps[i]), sweep_cases(scene, i));
  for (std::size_t i = 0; i < scene.grids.size(); ++i)
    add_cases(fmt::format("[[grid]] {}", i + 1),
              row_text(scene, scene.grids[i].x) + "; " + row_text(scene, scene.grids[i].y), grid_cases(scene, i));
  if (sampling)
    add("[monte_carlo]",
        sampling->by_default
            ? fmt::format("{} samples, because the phases of {} errors are not stated; samples = 0: none",
                          sampling->samples, sampling->variables.size())
            : fmt::format("{} samples of {} random inputs, seed {}", sampling->samples, sampling->variables.size(),
                          sampling->seed),
        static_cast<std::size_t>(sampling->samples), 0);
  if (scene.sensitivity) {
    const auto cases = sensitivity_cases(scene);
    add("[sensitivity]",
        fmt::format("{} inputs, each divided and multiplied by {}", cases.size() / 2,
                    to_text(scene.sensitivity->factor)),
        cases.size() + 1, count_tables(scene, cases));
  }
  if (scene.optimise) {
    const auto& o = *scene.optimise;
    const long searches = static_cast<long>(o.optimisers.size()) * o.repeats;
    const long points = searches * (o.generations + 1L) * o.population;
    std::string inputs;
    int tables = 0;
    for (const auto& v : scene.variables) {
      inputs += (inputs.empty() ? "" : ", ") + v.input;
      const StudyCase end{{{v.input, v.high}}, "[optimise]", ""};
      try {
        tables = std::max(tables, count_tables(scene, {end}));
      } catch (const InputError&) {  // an end of the range alone need not make a good scene
      }
    }
    list.push_back({"[optimise]",
                    fmt::format("{} over {}, {} search{} of {} generations of {}", fmt::join(o.objective, ", "), inputs,
                                searches, searches == 1 ? "" : "es", o.generations, o.population),
                    points, tables ? static_cast<int>(std::min(points * tables, 1'000'000'000L)) : 0,
                    each / static_cast<double>(variants) * static_cast<double>(points)});
  }
  return list;
}

}  // namespace annulus::app
