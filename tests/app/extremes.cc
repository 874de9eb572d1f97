#include "tests/app/extremes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "app/model/gear_system.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/mesh_model.h"
#include "app/scene/scene_schema.h"
#include "core/errors.h"
#include "tests/app/scene_edit.h"

namespace annulus::test {

namespace {

const app::Table& table_of(const std::string& path) {
  for (const auto& table : app::schema())
    if (table.path == path) return table;
  throw std::logic_error("no table " + path);
}

template <class Part>
double mean_over(const fem::LoadedMeshResult& result, const Part& part) {
  const auto& table = result.table;
  const int load = static_cast<int>(table.loads().size()) / 2;
  double sum = 0;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase) sum += part(table.at(position, phase, load));
  return sum / (table.positions() * table.phases());
}

/// Of the pins on the ring about its axis, for a load of one.
double pin_moment(const fem::PinHeld& pins, double outside, const fem::LoadedPosition& position) {
  // Lever arm of a parabola over an arc of +- beta: R (1 - beta^2 / 10).
  const double beta = pins.pin_diameter / 2 / outside;
  double moment = 0;
  for (const auto& pin : position.pins) moment += pin.tangential_force * outside * (1 - beta * beta / 10);
  return moment / position.load;
}

}  // namespace

std::string edited(const std::string& scene, const Edits& edits) {
  SceneEdit edit(scene);
  for (const auto& e : edits) edit.set(table_of(e.table), e.key, e.value);
  return edit.text();
}

std::string number(double value) { return fmt::format("{}", value); }

double Solved::stiffness() const {
  return mean_over(*result, [](const StiffnessEntry& e) { return e.stiffness_secant; });
}
double Solved::numerical_error() const {
  return mean_over(*result, [](const StiffnessEntry& e) { return e.error_relative - e.error_parts.model; });
}
double Solved::whole_error() const {
  return mean_over(*result, [](const StiffnessEntry& e) { return e.error_relative; });
}

Solved solve_scene(const std::string& text, const SolveChoice& choice) {
  Solved solved;
  solved.early = true;
  try {
    const auto scene = app::parse_scene(text, "scene.toml");
    app::check_stage(scene);
    const bool planetary = scene.stage.kind == "planetary";
    auto models = app::make_system(scene)->meshes();
    auto& model = planetary && !choice.sun ? models.at(1) : models.at(0);
    solved.early = false;
    solved.problem = *model.problem;
    solved.problem->phases = choice.phases;
    auto settings = model.settings;
    if (choice.degree) settings.degree = *choice.degree;
    if (choice.level) settings.level = choice.level;
    solved.result = fem::solve_loaded_mesh(*solved.problem, settings);
  } catch (const InputError& error) {
    solved.refusal = error.what();
  } catch (const std::exception& error) {
    solved.failure = error.what();
  }
  return solved;
}

std::vector<std::string> broken_rules(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& result) {
  // Sums of some hundred forces; of a ring on soft supports they lose what its rigid motion is larger than the
  // deflection of its teeth.
  constexpr double round_off = 1e-9;
  std::vector<std::string> broken;
  const auto rule = [&](bool holds, const std::string& what) {
    if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
  };
  const auto* pins = problem.structure.as<fem::PinHeld>();
  rule(!result.positions.empty(), "there are positions");
  // Gaps are differences of places: what they are known to.
  const double place = 1e-15 * problem.pair.wheel().tip_radius();
  for (const auto& p : result.positions) {
    const auto& e = p.entry;
    const double deflection = e.lte - e.unloaded_te;
    rule(std::isfinite(e.lte) && deflection > 0, "the load closes the flanks");
    rule(std::isfinite(e.stiffness_secant) && e.stiffness_secant > 0, "the secant stiffness is positive");
    rule(std::isfinite(e.stiffness_tangent) && e.stiffness_tangent > 0, "the tangent stiffness is positive");
    rule(std::isfinite(e.error_relative) && e.error_relative > 0, "the error is estimated");
    rule(std::isfinite(p.max_pressure) && p.max_pressure > 0, "there is a pressure");
    double share = 0;
    for (const double s : p.pair_share) {
      rule(s >= 0, "no pair pulls");
      share += s;
    }
    rule(std::abs(share - 1) < round_off, "pairs share the whole load");
    rule(p.force_balance_relative < round_off, "torque balances");
    rule(p.energy_balance_relative < round_off, "work is energy");
    rule(p.reciprocity_relative < round_off, "compliance is reciprocal");
    rule(p.max_penetration <= 1e-9 * deflection + place, "nothing penetrates");
    for (const auto& pin : p.pins)
      rule(!pins || !pins->unilateral || pin.radial_force >= -round_off * p.load, "no pin pulls");
    if (pins)  // over the chords of linear elements
      rule(std::abs(pin_moment(*pins, problem.wheel_support_radius, p) / problem.pair.wheel().base_radius() + 1) < 1e-4,
           "pins hold the torque");
  }
  double lte = 0;
  for (const auto& p : result.positions) lte = std::max(lte, p.entry.lte - p.entry.unloaded_te);
  rule(result.closure_relative * lte < 1e-9 * lte + 100 * place, "a mesh cycle closes");
  return broken;
}

}  // namespace annulus::test
