#include "app/model/plan_studies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/model/gear_system.h"
#include "app/model/study_cases.h"
#include "core/errors.h"
#include "dynamics/transient/transient.h"

namespace annulus::app {

namespace {

/// What changed scenes need besides the tables of the scene.
struct OwnTables {
  int count = 0;
  CostRun largest{};
  bool counted = true;  ///< one by one, not estimated from some of the cases

  void add(const Scene& scene, const StudyCase& study_case, int alike = 1) {
    for (const auto& mesh : tables_to_solve(scene, change_scene(scene, study_case))) {
      const auto size = mesh_size(mesh);
      if (count == 0 || processor_seconds(size) > processor_seconds(largest)) largest = size;
      count += alike;
    }
  }

  /// Cases that follow each other smoothly. Choosing a model can take a tenth of a second for each, so that of many
  /// only some are looked at; each stands for those that are nearest to it.
  void add_some(const Scene& scene, const std::vector<StudyCase>& cases) {
    constexpr std::size_t most = 8;
    const std::size_t looked_at = std::min(most, cases.size());
    counted = looked_at == cases.size();
    for (std::size_t i = 0; i < looked_at; ++i) {
      const auto begin = i * cases.size() / looked_at, end = (i + 1) * cases.size() / looked_at;
      add(scene, cases[(begin + end - 1) / 2], static_cast<int>(end - begin));
    }
  }
};

/// Responses of all variants together, by how much of them is asked for.
double response_seconds(const std::vector<PlannedResponse>& responses, double PlannedResponse::*of) {
  double seconds = 0;
  for (const auto& response : responses) seconds += response.*of;
  return seconds;
}

std::string row_text(const Scene& scene, const SweepInput& s) {
  const auto values = s.points();
  return fmt::format("{} from {} to {} {}, {} values", s.input, to_text(values.front()), to_text(values.back()),
                     unit_of_input(scene, s.input), values.size());
}

}  // namespace

std::vector<StudyPlan> plan_studies(const Scene& scene) {
  const auto system = make_system(scene);
  return plan_studies(*system, system->responses());
}

std::vector<StudyPlan> plan_studies(const GearSystem& system, const std::vector<PlannedResponse>& responses) {
  const auto& scene = system.scene();
  std::vector<StudyPlan> list;
  const auto sampling = sampling_of(scene);
  const bool any = !scene.sweeps.empty() || !scene.grids.empty() || scene.load_spectrum || !scene.transients.empty() ||
                   sampling || scene.sensitivity || scene.optimise;
  if (!any || !scene.dynamics) return list;
  const auto variants = static_cast<long>(system.variants().size());
  const double whole = response_seconds(responses, &PlannedResponse::study_s),
               searched = whole + response_seconds(responses, &PlannedResponse::study_search_s),
               sample = response_seconds(responses, &PlannedResponse::sample_s);
  const auto add = [&](std::string name, std::string what, std::size_t cases, double each, const OwnTables& tables) {
    const auto n = static_cast<long>(cases);
    list.push_back(
        {std::move(name), std::move(what), n * variants, tables.count, each * static_cast<double>(n), tables.largest});
    list.back().tables_counted = tables.counted;
  };
  const auto add_cases = [&](std::string name, std::string what, const std::vector<StudyCase>& cases,
                             std::size_t besides = 0) {
    OwnTables tables;
    tables.add_some(scene, cases);
    const bool searches = !cases.empty() && cases.front().other_motions;
    add(std::move(name), std::move(what), cases.size() + besides, searches ? searched : whole, tables);
  };
  // Rough: the branch of a spur pair had 200 points, and half of that again for the errors of its folds.
  constexpr std::size_t of_branches = 300;
  const auto more_points = [](const SweepInput& sweep, std::size_t cases) {
    return (sweep.goes_up() && sweep.goes_down() ? cases : 0) +
           (sweep.direction == SweepDirection::branches ? of_branches : 0);
  };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i)
    add_cases(fmt::format("[[sweep]] {}", i + 1), row_text(scene, scene.sweeps[i]), sweep_cases(scene, i),
              more_points(scene.sweeps[i], scene.sweeps[i].points().size()));
  for (std::size_t i = 0; i < scene.grids.size(); ++i)
    add_cases(fmt::format("[[grid]] {}", i + 1),
              row_text(scene, scene.grids[i].x) + "; " + row_text(scene, scene.grids[i].y), grid_cases(scene, i));
  if (scene.load_spectrum)
    add_cases("[load_spectrum]",
              fmt::format("{} classes of {}", scene.load_classes.size(), fmt::join(scene.load_spectrum->inputs, ", ")),
              load_cases(scene));
  if (const auto rough = scene.transients.empty() ? std::nullopt : system.rough_lumped())
    for (std::size_t i = 0; i < scene.transients.size(); ++i) {
      // Rough: a stage of ten meshes, its second integration and those on tables changed by their errors. Steps follow
      // vibrations, not the speed: a second takes as long at any speed.
      constexpr double per_cycle = 2e-3, settling = 100;
      const auto& t = scene.transients[i];
      const double settling_speed =
          std::max(std::abs(t.course().points.front().speed), dynamics::TransientOptions::slowest);
      add(fmt::format("[[transient]] {}", i + 1),
          fmt::format("{}: {} s of changing speed and torque", t.name, to_text(t.time.back())), 1,
          per_cycle * (t.time.back() * rough->problem.mesh_frequency + settling / settling_speed), {});
    }
  if (sampling)
    add("[monte_carlo]",
        sampling->by_default
            ? fmt::format("{} samples, because the phases of {} errors are not stated; samples = 0: none",
                          sampling->samples, sampling->variables.size())
            : fmt::format("{} samples of {} random inputs, seed {}", sampling->samples, sampling->variables.size(),
                          sampling->seed),
        static_cast<std::size_t>(sampling->samples), sample, {});
  if (scene.sensitivity) {
    const auto cases = sensitivity_cases(scene);
    OwnTables tables;
    for (const auto& study_case : cases) tables.add(scene, study_case);
    add("[sensitivity]",
        fmt::format("{} inputs, each divided and multiplied by {}", cases.size() / 2,
                    to_text(scene.sensitivity->factor)),
        cases.size() + 1, whole, tables);
  }
  if (scene.optimise) {
    const auto& o = *scene.optimise;
    const long searches = static_cast<long>(o.optimisers.size()) * o.repeats;
    const long points = searches * (o.generations + 1L) * o.population;
    std::string inputs;
    OwnTables tables;  // of a design: those of the end of a range that needs most
    for (const auto& v : scene.variables) {
      inputs += (inputs.empty() ? "" : ", ") + v.input;
      OwnTables of_end;
      try {
        of_end.add(scene, {{{v.input, v.high}}, "[optimise]", ""});
      } catch (const InputError&) {  // an end of the range alone need not make a good scene
      }
      if (of_end.count > tables.count) tables = of_end;
    }
    constexpr long of_an_int = 1'000'000'000;
    list.push_back({"[optimise]",
                    fmt::format("{} over {}, {} search{} of {} generations of {}", fmt::join(o.objective, ", "), inputs,
                                searches, searches == 1 ? "" : "es", o.generations, o.population),
                    points, static_cast<int>(std::min(points * tables.count, of_an_int)),
                    (asks_for_motion(o, system_kind(scene.stage.kind).model_figures()) ? whole : sample) /
                        static_cast<double>(variants) * static_cast<double>(points),
                    tables.largest, static_cast<int>(std::min(searches * o.population, of_an_int))});
  }
  return list;
}

}  // namespace annulus::app
