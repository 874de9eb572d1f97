#include "app/study/studies.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/model/gear_system.h"
#include "app/model/run_options.h"
#include "app/scene/input_place.h"
#include "core/errors.h"
#include "core/stopwatch.h"

namespace annulus::app {

namespace {

std::string place_of(const Scene& scene, const RandomVariable& variable) {
  for (std::size_t i = 0; i < scene.random_inputs.size(); ++i) {
    const auto paths = expand_planets(scene, scene.random_inputs[i].input);
    if (std::find(paths.begin(), paths.end(), variable.input) != paths.end())
      return place_text(scene, "monte_carlo.input.input", i);
  }
  return scene.file.string();
}

void check_random_input(const Scene& scene, const RandomVariable& variable, const Sampling& sampling) {
  const std::string where = "[[monte_carlo.input]] " + variable.input;
  const auto target = find_input(scene, variable.input);
  const auto place = place_of(scene, variable);
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("{}: {}: {}", place, where, why)); };
  if (target.parameter->kind == Parameter::Kind::integer) refuse("is a whole number; vary it with a [[sweep]]");
  try {
    variable.distribution.check();
  } catch (const InputError& error) {
    refuse(error.what());
  }
  for (int sample = 0; sample < sampling.samples; ++sample) {
    const double x = draw(variable, sampling.seed, sample);
    if (!target.parameter->in_range(x))
      refuse(fmt::format("sample {} draws {}, which must be in range: {}; truncate the distribution with low and high",
                         sample + 1, to_text(x, 6), target.parameter->range_text()));
  }
  const auto changed = change_scene(scene, {{{variable.input, draw(variable, sampling.seed, 0)}}, where, "", place});
  const auto tables = tables_to_solve(scene, changed);
  if (!tables.empty())
    refuse(
        fmt::format("changes the stiffness table of the {}, and every sample would have to compute it again; use "
                    "[[sweep]] or [sensitivity], or prescribe the stiffness in [mesh]",
                    tables.front().label()));
}

/// Why the branches of a sweep cannot be followed; empty where they can.
std::string broken_branch(const Scene& scene, const SweepInput& sweep) {
  if (find_input(scene, sweep.input).parameter->kind == Parameter::Kind::integer)
    return "it is a whole number, and a branch runs through all values between";
  const auto values = sweep.points();
  for (const double value : {values.front(), values.back()}) {
    const auto tables = tables_to_solve(scene, change_scene(scene, {{{sweep.input, value}}, "[[sweep]]", ""}));
    if (!tables.empty())
      return fmt::format(
          "it changes the stiffness table of the {}, which every point of a branch would have to "
          "compute again",
          tables.front().label());
  }
  return "";
}

void check_directions(const Scene& scene) {
  const auto system = make_system(scene);
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i) {
    const auto& sweep = scene.sweeps[i];
    const auto refuse = [&](const std::string& why) {
      throw InputError(fmt::format("{}: sweep.direction = \"{}\" {}; use \"{}\"",
                                   place_text(scene, "sweep.direction", i),
                                   direction_names.at(static_cast<std::size_t>(sweep.direction)), why,
                                   system->offers(SweepDirection::both) ? "both" : "each"));
    };
    if (!system->offers(sweep.direction)) refuse("is not offered for stages of kind " + scene.stage.kind);
    if (sweep.direction != SweepDirection::branches) continue;
    if (const auto rough = system->rough_lumped(); rough && rough->system.has_friction())
      refuse("is not found with friction on the flanks ([friction])");
    if (const auto why = broken_branch(scene, sweep); !why.empty())
      refuse(fmt::format("cannot follow {}: {}", sweep.input, why));
  }
}

void check_transients(const Scene& scene) {
  if (scene.transients.empty()) return;
  const auto system = make_system(scene);
  if (!system->offers(SweepDirection::up))
    throw InputError(fmt::format("{}: [[transient]] is not offered for stages of kind {}",
                                 place_text(scene, "transient.time_s", 0), scene.stage.kind));
  const auto rough = system->rough_lumped();
  for (std::size_t i = 0; rough && i < scene.transients.size(); ++i) {
    constexpr double most = dynamics::TransientOptions::most_cycles;
    const double cycles = dynamics::CourseCycles(scene.transients[i].course(), dynamics::TransientOptions::slowest,
                                                 rough->problem.mesh_frequency)
                              .last();
    if (cycles > most)
      throw InputError(fmt::format(
          "{}: transient.time_s: the course has {:.3g} mesh cycles, a standstill counted as {:g} of the "
          "speed; {:g} are possible. Use shorter times, as slower changes than these leave the motion steady",
          place_text(scene, "transient.time_s", i), cycles, dynamics::TransientOptions::slowest, most));
    try {
      const auto& input = scene.transients[i];
      (void)dynamics::Pacing(rough->system, input.course(), rough->turning.dof, rough->turning.velocity,
                             input.accelerated_by);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: [[transient]] '{}': {}", place_text(scene, "transient.time_s", i),
                                   scene.transients[i].name, error.what()));
    }
  }
}

void check_objective(const Scene& scene) {
  if (!scene.optimise) return;
  const auto system = make_system(scene);
  for (const auto& result : scene.optimise->objective)
    if (const auto table = system->table_for(result); !table.empty())
      throw InputError(fmt::format("{}: optimise.objective: a scene without {} has no {}",
                                   place_text(scene, "optimise.objective"), table, result));
}

}  // namespace

void check_studies(const Scene& scene) {
  if (!scene.dynamics) return;
  check_objective(scene);
  check_directions(scene);
  check_transients(scene);
  for (const auto& study_case : all_cases(scene)) (void)change_scene(scene, study_case);
  const auto sampling = sampling_of(scene);
  if (!sampling) return;
  if (sampling->variables.empty())
    throw InputError(place_text(scene, "monte_carlo.samples") +
                     ": [monte_carlo]: nothing is uncertain: there are no errors of unknown phase and no "
                     "[[monte_carlo.input]]");
  for (const auto& variable : sampling->variables) {
    const bool phase = variable.input.find("_phase_deg") != std::string::npos;
    if (!phase) check_random_input(scene, variable, *sampling);
  }
}

StudyResults run_studies(const StudySubject& subject) {
  const auto& scene = subject.scene();
  StudyResults results{.variants = subject.variants(),
                       .variant_word = variant_word(subject.scene().stage.kind),
                       .figures = subject.figures()};
  for (std::size_t i = 0; i < results.variants.size(); ++i) results.nominal.push_back(subject.nominal(i));
  if (!scene.dynamics) return results;
  const auto& reuse = subject.options().reuse;
  const auto responses = [&] {
    if (!reuse) return Reuse::Count{};
    const auto points = reuse->counted(study_responses), searched = reuse->counted(search_evaluations);
    return Reuse::Count{points.reused + searched.reused, points.computed + searched.computed};
  };
  const auto timed = [&](const std::string& name, const auto& study) {
    const auto before = responses();
    const Stopwatch watch;
    study();
    const auto after = responses();
    const auto reused = static_cast<double>(after.reused - before.reused);
    const auto computed = static_cast<double>(after.computed - before.computed);
    if (reused == 0)
      results.times[name] = {watch.seconds(), 1};
    else if (computed > 0)
      results.times[name] = {watch.seconds(), computed / (computed + reused)};
  };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i)
    timed(fmt::format("[[sweep]] {}", i + 1), [&] { results.sweeps.push_back(run_sweep(subject, i)); });
  for (std::size_t i = 0; i < scene.grids.size(); ++i)
    timed(fmt::format("[[grid]] {}", i + 1), [&] { results.grids.push_back(run_grid(subject, i)); });
  if (scene.load_spectrum) timed("[load_spectrum]", [&] { results.load_spectrum = run_load_spectrum(subject); });
  for (std::size_t i = 0; i < scene.transients.size(); ++i)
    timed(fmt::format("[[transient]] {}", i + 1), [&] { results.transients.push_back(run_transient(subject, i)); });
  if (const auto sampling = sampling_of(scene))
    timed("[monte_carlo]", [&] { results.monte_carlo = run_monte_carlo(subject, *sampling); });
  if (scene.optimise) timed("[optimise]", [&] { results.optimise = run_optimise(subject); });
  if (scene.sensitivity) timed("[sensitivity]", [&] { results.sensitivity = run_sensitivity(subject); });
  return results;
}

}  // namespace annulus::app
