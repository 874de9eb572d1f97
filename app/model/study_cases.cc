#include "app/model/study_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/model/gear_system.h"
#include "app/scene/input_place.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// An error that has a direction or a phase: errors.<name>_um and errors.<name>_phase_deg.
struct PhasedError {
  std::string name;
  bool of_each_planet = false;
};

std::vector<PhasedError> phased_errors(const std::string& kind) {
  constexpr std::string_view ending = "_phase_deg";
  std::vector<PhasedError> list;
  const auto* errors = find_table("errors", schema(kind));
  if (errors == nullptr) return list;
  for (const auto& p : errors->parameters)
    if (p.name.ends_with(ending))
      list.push_back({p.name.substr(0, p.name.size() - ending.size()), p.kind == Parameter::Kind::reals});
  return list;
}

bool drawn(const Scene& scene, const std::string& path) {
  for (const auto& random : scene.random_inputs) {
    for (const auto& p : expand_planets(scene, random.input)) {
      if (p == path) return true;
    }
  }
  return false;
}

/// Written in the scene, and not as an assumption.
bool stated(const Scene& scene, const std::string& key) {
  return std::any_of(scene.inputs.begin(), scene.inputs.end(), [&](const Input& input) {
    return input.key == key && input.origin == Origin::scene && input.assumed.empty() &&
           !std::holds_alternative<std::monostate>(input.value);
  });
}

/// Phases that matter: of errors that the scene gives or draws, those that it states left out on request.
std::vector<std::string> unknown_phases(const Scene& scene, bool unstated_only) {
  std::vector<std::string> paths;
  for (const auto& [name, of_each_planet] : phased_errors(scene.stage.kind)) {
    if (unstated_only && stated(scene, fmt::format("errors.{}_phase_deg", name))) continue;
    for (int n = 1; n <= (of_each_planet ? scene.stage.planets : 1); ++n) {
      const std::string index = of_each_planet ? fmt::format("[{}]", n) : "";
      const std::string amount = fmt::format("errors.{}_um{}", name, index),
                        phase = fmt::format("errors.{}_phase_deg{}", name, index);
      const auto* input = scene.find(fmt::format("errors.{}_um", name));
      const bool follows = input != nullptr && input->origin == Origin::derived;
      const bool exists =
          follows || input_value(scene, find_input(scene, amount)).value_or(0) != 0 || drawn(scene, amount);
      if (exists && !drawn(scene, phase)) paths.push_back(phase);
    }
  }
  return paths;
}

/// The key itself, or one path for each value of its list.
std::vector<std::string> paths_of(const Scene& scene, const Parameter& p) {
  if (p.kind != Parameter::Kind::reals) return {p.key()};
  const Input* input = scene.find(p.key());
  const auto* list = input ? std::get_if<std::vector<double>>(&input->value) : nullptr;
  std::vector<std::string> paths;
  for (std::size_t n = 1; list && n <= list->size(); ++n) paths.push_back(fmt::format("{}[{}]", p.key(), n));
  return paths;
}

dynamics::Distribution distribution_of(const RandomInput& r) {
  using Kind = dynamics::Distribution::Kind;
  dynamics::Distribution d;
  d.kind = r.distribution == RandomKind::uniform  ? Kind::uniform
           : r.distribution == RandomKind::normal ? Kind::normal
                                                  : Kind::lognormal;
  d.mean = r.mean.value_or(0);
  d.deviation = r.deviation.value_or(0);
  d.low = r.low.value_or(d.low);
  d.high = r.high.value_or(d.high);
  return d;
}

}  // namespace

void rethrow_at(const Scene& scene, const std::string& where, const std::string& place) {
  const std::string head = (place.empty() ? scene.file.string() : place) + ": " + where + ": ";
  try {
    throw;
  } catch (const SceneError& error) {
    throw InputError(head + error.problems().front().message);
  } catch (const InputError& error) {
    throw InputError(head + without_place(scene, error.what()));
  }
}

Scene change_scene(const Scene& scene, const StudyCase& study_case) {
  try {
    Scene changed = with_overrides(scene, study_case.overrides);
    check_stage(changed);
    return changed;
  } catch (const InputError&) {
    rethrow_at(scene, study_case.where, study_case.place);
  }
}

namespace {

/// "stage.power_kW = 900, ..."
std::string shown(const std::vector<Override>& point) {
  std::vector<std::string> texts;
  for (const auto& o : point) texts.push_back(o.input + " = " + to_text(o.value));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Inputs and values as a name of a folder.
std::string folder_of(const std::vector<Override>& point, const char* between) {
  std::vector<std::string> parts;
  for (const auto& o : point) {
    parts.push_back(file_name(o.input));
    parts.push_back(to_text(o.value, 15));
  }
  return fmt::format("{}", fmt::join(parts, between));
}

/// All combinations of the values of some inputs, the first input fastest. `study`: "[[grid]] 1", `noun`: of a case;
/// `folder`: from the values as texts.
std::vector<StudyCase> combinations(const std::vector<SweepInput>& inputs, const std::string& study, const char* noun,
                                    const std::string& place) {
  std::vector<std::vector<Override>> points = {{}};
  for (auto input = inputs.rbegin(); input != inputs.rend(); ++input) {
    std::vector<std::vector<Override>> longer;
    for (const auto& point : points)
      for (const double value : input->points()) {
        longer.push_back(point);
        longer.back().insert(longer.back().begin(), {input->input, value});
      }
    points = std::move(longer);
  }
  std::vector<StudyCase> cases;
  for (auto& point : points) {
    const auto where = fmt::format("{}, {} {} of {} ({})", study, noun, cases.size() + 1, points.size(), shown(point));
    const auto folder = inputs.size() == 1 ? "sweep/" + folder_of(point, "/") : "grid/" + folder_of(point, "_");
    cases.push_back({std::move(point), where, folder, place});
  }
  return cases;
}

}  // namespace

std::string unit_of_input(const Scene& scene, const std::string& input) {
  return find_input(scene, input).parameter->unit;
}

std::vector<StudyCase> sweep_cases(const Scene& scene, std::size_t sweep) {
  auto cases = combinations({scene.sweeps.at(sweep)}, fmt::format("[[sweep]] {}", sweep + 1), "value",
                            place_text(scene, "sweep.input", sweep));
  for (auto& study_case : cases) study_case.other_motions = scene.sweeps.at(sweep).direction == SweepDirection::each;
  return cases;
}

std::vector<StudyCase> grid_cases(const Scene& scene, std::size_t grid) {
  const auto& g = scene.grids.at(grid);
  return combinations({g.x, g.y}, fmt::format("[[grid]] {}", grid + 1), "point",
                      place_text(scene, "grid.x_input", grid));
}

std::vector<StudyCase> load_cases(const Scene& scene) {
  std::vector<StudyCase> cases;
  if (!scene.load_spectrum) return cases;
  const auto& inputs = scene.load_spectrum->inputs;
  for (std::size_t n = 0; n < scene.load_classes.size(); ++n) {
    const auto& load = scene.load_classes[n];
    StudyCase made;
    for (std::size_t i = 0; i < inputs.size(); ++i) made.overrides.push_back({inputs[i], load.values[i]});
    made.where = fmt::format("[[load_spectrum.class]] '{}' ({})", load.name, shown(made.overrides));
    made.folder = "load_spectrum/" + folder_of(made.overrides, "_");
    made.place = place_text(scene, "load_spectrum.class.values", n);
    made.other_motions = true;
    cases.push_back(std::move(made));
  }
  return cases;
}

std::vector<std::string> sensitivity_inputs(const Scene& scene) {
  if (!scene.sensitivity) return {};
  if (!scene.sensitivity->inputs.empty()) return scene.sensitivity->inputs;
  std::vector<std::string> inputs;
  for (const auto& table : schema(scene.stage.kind)) {
    for (const auto& p : table.parameters) {
      if (!p.often_assumed || !p.applies_to(scene.stage.kind)) continue;
      for (const auto& path : paths_of(scene, p)) {
        const double value = input_value(scene, find_input(scene, path)).value_or(0);
        if (value != 0 && std::isfinite(value)) inputs.push_back(path);
      }
    }
  }
  return inputs;
}

std::vector<StudyCase> sensitivity_cases(const Scene& scene) {
  std::vector<StudyCase> cases;
  const auto place = place_text(scene, "sensitivity.factor");
  for (const auto& input : sensitivity_inputs(scene)) {
    const double factor = scene.sensitivity->factor;
    for (const bool multiplied : {false, true}) {
      const std::string text = (multiplied ? "times_" : "over_") + to_text(factor, 15);
      cases.push_back({{{input, multiplied ? factor : 1 / factor, true}},
                       fmt::format("[sensitivity] {} {} {}", input, multiplied ? "×" : "/", to_text(factor)),
                       "sensitivity/" + file_name(input) + "/" + text,
                       place});
    }
  }
  return cases;
}

StudyCase nominal_case_of_sensitivity() { return {{}, "[sensitivity] nominal", ""}; }

std::vector<StudyCase> all_cases(const Scene& scene) {
  std::vector<StudyCase> all;
  const auto add = [&](const std::vector<StudyCase>& cases) { all.insert(all.end(), cases.begin(), cases.end()); };
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i) add(sweep_cases(scene, i));
  for (std::size_t i = 0; i < scene.grids.size(); ++i) add(grid_cases(scene, i));
  add(load_cases(scene));
  add(sensitivity_cases(scene));
  return all;
}

std::vector<std::string> unstated_phases(const Scene& scene) { return unknown_phases(scene, true); }

bool asks_for_motion(const OptimiseInput& search, const std::vector<FigureSpec>& figures) {
  return std::any_of(search.objective.begin(), search.objective.end(),
                     [&](const std::string& key) { return find_figure(figures, key)->effort == FigureEffort::motion; });
}

std::optional<Sampling> sampling_of(const Scene& scene) {
  if (!scene.dynamics) return std::nullopt;
  // One of them is expected beyond either end of the range from 5 % to 95 %.
  constexpr int few = 20;
  const auto& asked = scene.monte_carlo;
  Sampling sampling{.samples = few, .seed = 1, .variables = {}, .by_default = !asked};
  if (asked) sampling.samples = asked->samples, sampling.seed = asked->seed;
  if (!asked || asked->phases == ErrorPhases::unknown)
    for (const auto& path : unknown_phases(scene, !asked))
      sampling.variables.push_back({path, {.low = 0, .high = 360}});
  for (const auto& random : scene.random_inputs)
    for (const auto& path : expand_planets(scene, random.input))
      sampling.variables.push_back({path, distribution_of(random)});
  if (sampling.samples == 0 || (!asked && sampling.variables.empty())) return std::nullopt;
  return sampling;
}

namespace {

/// Name of the random numbers of an input. A renamed key has those of its first name, so that the samples of a seed
/// stay the same.
std::string random_stream(const std::string& input) {
  const std::string key = input.substr(0, input.find('['));
  const auto* parameter = find_parameter(key);
  if (!parameter || parameter->old_names.empty()) return input;
  return key.substr(0, key.rfind('.') + 1) + parameter->old_names.front() + input.substr(key.size());
}

}  // namespace

double draw(const RandomVariable& variable, int seed, int sample) {
  return variable.distribution.quantile(dynamics::uniform_draw(
      static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(sample), random_stream(variable.input)));
}

StudyCase sample_case(const std::vector<RandomVariable>& variables, int seed, int sample) {
  StudyCase result{{}, fmt::format("[monte_carlo] sample {}", sample + 1), ""};
  for (const auto& variable : variables) result.overrides.push_back({variable.input, draw(variable, seed, sample)});
  return result;
}

}  // namespace annulus::app
