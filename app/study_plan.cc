#include "app/study_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/changed_stage.h"
#include "app/study_cases.h"
#include "dynamics/study_point.h"

namespace annulus::app {

namespace {

/// How many of the cases need tables of their own, and how many tables.
int tables_to_solve(const Scene& scene, const GearGeometry& geometry, const std::vector<StudyCase>& cases) {
  const auto nominal = mesh_models(scene, geometry);
  int tables = 0;
  for (const auto& study_case : cases) {
    const auto changed = change_scene(scene, study_case);
    const auto models = mesh_models(changed.scene, changed.geometry);
    for (std::size_t i = 0; i < models.size(); ++i)
      tables += table_serves(nominal[i], models[i], changed.geometry.operating_point.mean_mesh_force) ? 0 : 1;
  }
  return tables;
}

/// Rough time of one response of every ring: the period follows from errors and tables, not from stiffness.
double seconds_of_all_rings(const Scene& scene, const GearGeometry& geometry) {
  Scene rough = scene;
  rough.sun_planet = {};
  rough.sun_planet.stiffness = StiffnessShape::constant;
  rough.sun_planet.mean = 1e9;
  rough.ring_planet = rough.sun_planet;
  const auto models = mesh_models(scene, geometry);
  double seconds = 0;
  // A constant stiffness reads no table: any will do.
  const MeshResult none{
      .model = {},
      .table = StiffnessTable("sun_planet", 4, {0.0}, {1.0}, std::vector<StiffnessEntry>(4, {0, 1, 1, 1, 0}))};
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto stage = make_stage(rough, geometry, i, none, none);
    const int period = std::lcm(stage.error_period(), models[i + 1].positions);
    const auto options = simulation_options(scene, stage);
    seconds += dynamics::point_seconds(stage, std::min(period, std::max(options.max_window_cycles, 4000)));
  }
  return seconds;
}

}  // namespace

std::vector<StudyPlan> plan_studies(const Scene& scene, const GearGeometry& geometry) {
  std::vector<StudyPlan> list;
  const bool any = !scene.sweeps.empty() || scene.monte_carlo || scene.sensitivity;
  if (!any || !scene.dynamics) return list;
  const auto rings = static_cast<long>(scene.rings.size());
  const double each = seconds_of_all_rings(scene, geometry);
  const auto add = [&](std::string name, std::string what, std::size_t cases, int tables) {
    const auto n = static_cast<long>(cases);
    list.push_back({std::move(name), std::move(what), n * rings, tables, each * static_cast<double>(n)});
  };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i) {
    const auto& s = scene.sweeps[i];
    const auto cases = sweep_cases(scene, i);
    const auto values = s.points();
    add(fmt::format("[[sweep]] {}", i + 1),
        fmt::format("{} from {} to {} {}, {} values", s.input, to_text(values.front()), to_text(values.back()),
                    find_input(scene, s.input).parameter->unit, values.size()),
        cases.size(), tables_to_solve(scene, geometry, cases));
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
        cases.size() + 1, tables_to_solve(scene, geometry, cases));
  }
  return list;
}

}  // namespace annulus::app
