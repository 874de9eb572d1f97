#include "app/studies.h"

#include <fmt/format.h>

#include "app/point_store.h"
#include "app/progress.h"
#include "app/study_runner.h"
#include "app/tasks.h"
#include "core/log.h"

namespace annulus::app {

namespace {

void check_random_input(const Scene& scene, const std::vector<MeshModel>& nominal, const GearGeometry& geometry,
                        const RandomVariable& variable) {
  const std::string where = "[[monte_carlo.input]] " + variable.input;
  const auto target = find_input(scene, variable.input);
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}: {}", scene.file.string(), where, why));
  };
  if (target.parameter->kind == Parameter::Kind::integer) refuse("is a whole number; a [[sweep]] suits it");
  try {
    variable.distribution.check();
  } catch (const InputError& error) {
    refuse(error.what());
  }
  for (int sample = 0; sample < scene.monte_carlo->samples; ++sample) {
    const double x = draw(variable, scene.monte_carlo->seed, sample);
    if (!target.parameter->in_range(x))
      refuse(fmt::format("sample {} draws {}, which must be in range: {}; truncate the distribution with low and high",
                         sample + 1, to_text(x, 6), target.parameter->range_text()));
  }
  const auto changed = change_scene(scene, {{{variable.input, draw(variable, scene.monte_carlo->seed, 0)}}, where, ""});
  const auto models = mesh_models(changed.scene, changed.geometry);
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (!table_serves(nominal[i], models[i], geometry.operating_point.mean_mesh_force))
      refuse(
          fmt::format("changes the stiffness table of the {}, which every sample would have to solve again; use "
                      "[[sweep]] or [sensitivity], or give the stiffness in [mesh]",
                      models[i].label()));
  }
}

}  // namespace

void check_studies(const Scene& scene) {
  if (!scene.dynamics) return;
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i) {
    for (const auto& study_case : sweep_cases(scene, i)) (void)change_scene(scene, study_case);
  }
  for (const auto& study_case : sensitivity_cases(scene)) (void)change_scene(scene, study_case);
  if (!scene.monte_carlo) return;
  const auto variables = random_variables(scene);
  if (variables.empty())
    throw InputError(scene.file.string() +
                     ": [monte_carlo]: nothing is uncertain: there are no errors of unknown phase and no "
                     "[[monte_carlo.input]]");
  const auto geometry = make_geometry(scene);
  const auto models = mesh_models(scene, geometry);
  for (const auto& variable : variables) {
    const bool phase = variable.input.find("_phase_deg") != std::string::npos;
    if (!phase) check_random_input(scene, models, geometry, variable);
  }
}

CasePoints run_cases(const ChangedStages& stages, const std::vector<StudyCase>& cases, const std::string& label) {
  const std::size_t rings = stages.nominal().rings.size(), n = cases.size();
  CasePoints result;
  result.rings.assign(rings, std::vector<StudyPoint>(n));
  std::vector<std::string> failures(n);
  for (std::size_t i = 0; i < n; ++i) {
    try {
      result.tables += stages.prepare(cases[i].overrides, cases[i].where, cases[i].folder) ? 1 : 0;
    } catch (const SolverError& error) {
      failures[i] = error.what();
    }
  }
  TaskProgress progress(label, n * rings);
  const PointStore store(stages);
  for_each_task(n * rings, stages.options().threads, [&](std::size_t task) {
    const std::size_t i = task / rings, ring = task % rings;
    auto& point = result.rings[ring][i];
    if (failures[i].empty())
      point = store.point(cases[i].overrides, cases[i].where, ring, cases[i].folder);
    else
      point.failure = failures[i];
    progress.done();
  });
  std::size_t failed = 0;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto& point = result.rings[ring][i];
      if (point.failure.empty()) continue;
      ++failed;
      log::warn(fmt::format("{}, ring '{}': {}", cases[i].where, stages.nominal().rings[ring].name, point.failure));
    }
  }
  progress.finish(fmt::format("{} responses{}", n * rings, failed ? fmt::format(", {} failed", failed) : ""));
  return result;
}

StudyResults run_studies(const RunResult& nominal, const RunOptions& options) {
  StudyResults results;
  if (!nominal.scene.dynamics) return results;
  for (std::size_t i = 0; i < nominal.scene.sweeps.size(); ++i)
    results.sweeps.push_back(run_sweep(nominal, options, i));
  if (nominal.scene.monte_carlo) results.monte_carlo = run_monte_carlo(nominal, options);
  if (nominal.scene.sensitivity) results.sensitivity = run_sensitivity(nominal, options);
  return results;
}

}  // namespace annulus::app
