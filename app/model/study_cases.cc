#include "app/model/study_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/gear_system.h"
#include "app/scene/input_place.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

constexpr const char* error_bodies[] = {"planet_eccentricity",  "planet_pin_position_error",
                                        "sun_eccentricity",     "sun_position_error",
                                        "ring_eccentricity",    "ring_position_error",
                                        "carrier_eccentricity", "carrier_position_error",
                                        "mesh_error",           "pinion_error",
                                        "wheel_error"};

bool drawn(const Scene& scene, const std::string& path) {
  for (const auto& random : scene.random_inputs) {
    for (const auto& p : expand_planets(scene, random.input)) {
      if (p == path) return true;
    }
  }
  return false;
}

/// Phases that matter: of errors that the scene gives or draws.
std::vector<std::string> unknown_phases(const Scene& scene) {
  std::vector<std::string> paths;
  for (const std::string body : error_bodies) {
    if (!find_parameter("errors." + body + "_um")->applies_to(scene.stage.kind)) continue;
    const bool planets = body.starts_with("planet");
    for (int n = 1; n <= (planets ? scene.stage.planets : 1); ++n) {
      const std::string index = planets ? fmt::format("[{}]", n) : "";
      const std::string amount = fmt::format("errors.{}_um{}", body, index),
                        phase = fmt::format("errors.{}_phase_deg{}", body, index);
      const bool exists =
          input_value(scene, find_input(scene, amount)).value_or(0) != 0 || drawn(scene, amount) ||
          (body == "mesh_error" && scene.manufacturing_error && scene.manufacturing_error->reading != "none");
      if (exists && !drawn(scene, phase)) paths.push_back(phase);
    }
  }
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

std::vector<StudyCase> sweep_cases(const Scene& scene, std::size_t sweep) {
  const auto& s = scene.sweeps.at(sweep);
  const auto values = s.points();
  const auto place = place_text(scene, "sweep.input", sweep);
  std::vector<StudyCase> cases;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string text = to_text(values[i], 15);
    cases.push_back({{{s.input, values[i]}},
                     fmt::format("[[sweep]] {}, value {} of {} ({} = {})", sweep + 1, i + 1, values.size(), s.input,
                                 to_text(values[i])),
                     "sweep/" + file_name(s.input) + "/" + text,
                     place});
  }
  return cases;
}

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

std::vector<StudyCase> grid_cases(const Scene& scene, std::size_t grid) {
  const auto& g = scene.grids.at(grid);
  const auto xs = g.x.points(), ys = g.y.points();
  const auto place = place_text(scene, "grid.x_input", grid);
  std::vector<StudyCase> cases;
  for (const double y : ys) {
    for (const double x : xs)
      cases.push_back(
          {{{g.x.input, x}, {g.y.input, y}},
           fmt::format("[[grid]] {}, point {} of {} ({} = {}, {} = {})", grid + 1, cases.size() + 1,
                       xs.size() * ys.size(), g.x.input, to_text(x), g.y.input, to_text(y)),
           fmt::format("grid/{}_{}_{}_{}", file_name(g.x.input), to_text(x, 15), file_name(g.y.input), to_text(y, 15)),
           place});
  }
  return cases;
}

namespace {

/// Stiffnesses and inertias of a 2K-V stage.
bool among_usually_assumed(const Parameter& p) {
  for (const char* table : {"crank", "arc_gear", "input", "output"}) {
    if (p.table == table && (p.unit == "N/m" || p.unit == "N m/rad" || p.unit == "kg m²" || p.unit == "kg"))
      return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> sensitivity_inputs(const Scene& scene) {
  if (!scene.sensitivity) return {};
  if (!scene.sensitivity->inputs.empty()) return scene.sensitivity->inputs;
  std::vector<std::string> inputs;
  for (const auto& table : schema()) {
    for (const auto& p : table.parameters) {
      const bool assumed_mostly = p.table == "supports" || p.name.starts_with("bearing_") ||
                                  p.key() == "dynamics.mesh_damping_ratio" ||
                                  p.key() == "dynamics.support_damping_ratio" || p.key() == "dynamics.half_backlash_um";
      if (!assumed_mostly || !table.applies_to(scene.stage.kind) || !p.applies_to(scene.stage.kind)) continue;
      const double value = input_value(scene, find_input(scene, p.key())).value_or(0);
      if (value != 0 && std::isfinite(value)) inputs.push_back(p.key());
    }
  }
  for (const auto& table : schema()) {
    for (const auto& p : table.parameters) {
      if (!among_usually_assumed(p) || !table.applies_to(scene.stage.kind)) continue;
      const double value = input_value(scene, find_input(scene, p.key())).value_or(0);
      const bool listed = std::find(inputs.begin(), inputs.end(), p.key()) != inputs.end();
      if (!listed && value != 0 && std::isfinite(value)) inputs.push_back(p.key());
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

std::vector<RandomVariable> random_variables(const Scene& scene) {
  std::vector<RandomVariable> variables;
  if (!scene.monte_carlo) return variables;
  if (scene.monte_carlo->phases == ErrorPhases::unknown) {
    for (const auto& path : unknown_phases(scene)) variables.push_back({path, {.low = 0, .high = 360}});
  }
  for (const auto& random : scene.random_inputs) {
    for (const auto& path : expand_planets(scene, random.input)) variables.push_back({path, distribution_of(random)});
  }
  return variables;
}

namespace {

/// Name of the random numbers of an input. A renamed key keeps those of its first name, so that the samples of a seed
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
