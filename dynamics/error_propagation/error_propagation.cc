#include "dynamics/error_propagation/error_propagation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/errors.h"
#include "core/log.h"
#include "core/table_variants.h"
#include "dynamics/figures/common_figures.h"

namespace annulus::dynamics {

namespace {

using TableChange = std::function<StiffnessTable(const TabulatedMesh&)>;
using Differences = std::map<std::string, double>;  // by the key of the result

template <StiffnessTable (*change)(const StiffnessTable&)>
StiffnessTable of_table(const TabulatedMesh& mesh) {
  return change(mesh.table);
}

constexpr std::size_t all_meshes = static_cast<std::size_t>(-1);

bool any_error(const StiffnessTable& table) {
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase)
      for (int load = 0; load < static_cast<int>(table.loads().size()); ++load)
        if (table.at(position, phase, load).error_relative > 0) return true;
  return false;
}

/// The harmonic balance is the motion to compare where it alone was asked, and where time integration stayed on it.
bool taken_directly(const SteadyOutcome& nominal) {
  return nominal.periodic && nominal.periodic->converged && (nominal.confirmed || nominal.total_cycles == 0);
}

/// Evaluates the model on changed tables.
class Comparison {
 public:
  Comparison(const Evaluation& nominal, const TabulatedModel& model) : model_(model), nominal_(nominal) {
    if (model.nominal_alike) base_ = nominal;
  }

  /// |difference| of every result to the unchanged tables, one mesh or all of them changed.
  Differences differences(const TableChange& change, std::size_t mesh, const std::string& what) {
    Differences result;
    for (const auto& entry : nominal_.figures.entries()) result[entry.key] = not_known;
    const Evaluation* base = unchanged();
    if (!base) return result;
    try {
      const auto changed = model_.evaluate(tables(change, mesh));
      // A change that ends the periodic motion has done so much at least.
      if (model_.seeks_steady_state && base->outcome.steady && !changed.outcome.steady)
        log::warn(fmt::format("no steady state with {}: the results of its last mesh cycles are compared", what));
      for (auto& [key, difference] : result)
        difference = std::abs(changed.figures.value(key) - base->figures.value(key));
    } catch (const Error& error) {  // no solution, or a changed table from which no law follows
      log::warn(fmt::format("{}: {}: its effect on the results is not known", what, error.what()));
    }
    return result;
  }

 private:
  /// The results on the unchanged tables, found in the way of the others; null where that way finds none.
  const Evaluation* unchanged() {
    if (!base_ && !failed_) {
      try {
        base_ = model_.evaluate(tables(nullptr, all_meshes));
      } catch (const Error& error) {
        failed_ = true;
        log::warn(fmt::format("the unchanged tables: {}: the effect of their errors on the results is not known",
                              error.what()));
      }
    }
    return base_ ? &*base_ : nullptr;
  }

  [[nodiscard]] std::vector<StiffnessTable> tables(const TableChange& change, std::size_t mesh) const {
    std::vector<StiffnessTable> list;
    for (std::size_t i = 0; i < model_.meshes.size(); ++i) {
      const auto& given = model_.meshes[i];
      list.push_back(change && (mesh == all_meshes || mesh == i) ? change(given) : given.table);
    }
    return list;
  }

  const TabulatedModel& model_;
  const Evaluation& nominal_;
  std::optional<Evaluation> base_;
  bool failed_ = false;
};

/// What the error estimate of one mesh's stiffness does to every result; NaN where one of the changes is not known.
Differences stiffness_differences(Comparison& comparison, const TabulatedModel& model, std::size_t mesh) {
  const auto in_mesh = " in the " + model.meshes[mesh].name;
  auto part = comparison.differences(of_table<stiffer>, mesh, "more stiffness" + in_mesh);
  for (const auto& [key, ripple] : comparison.differences(of_table<more_rippled>, mesh, "more ripple" + in_mesh)) {
    double& larger = part.at(key);
    larger = std::isnan(larger + ripple) ? not_known : std::max(larger, ripple);
  }
  return part;
}

/// Adds the error that a result has by a mesh's stiffness, in the proportions of that stiffness' own error.
void add_stiffness_error(double error, const ErrorParts& of_stiffness, ErrorParts& parts) {
  double whole = 0;
  for (const auto& [name, part] : stiffness_error_part_names) whole += of_stiffness.*part;
  if (whole <= 0) {
    parts.discretisation += error;
    return;
  }
  for (const auto& [name, part] : stiffness_error_part_names)
    if (of_stiffness.*part > 0) parts.*part += error * (of_stiffness.*part / whole);
}

constexpr double smallest_jump = 1e-3;  // relative to the mean stiffness

TableChange jumps(JumpSide side) {
  return [side](const TabulatedMesh& mesh) { return with_jumps(mesh.table, side, mesh.uptake); };
}
StiffnessTable much_coarser(const StiffnessTable& table) { return coarser(coarser(table)); }

Differences interpolation_differences(Comparison& comparison, const TabulatedModel& model) {
  const auto divisible = [&](int by) {
    return std::all_of(model.meshes.begin(), model.meshes.end(),
                       [&](const TabulatedMesh& mesh) { return mesh.table.phases() % by == 0; });
  };
  if (!divisible(2) || model.meshes.empty()) return {};
  auto part = comparison.differences(of_table<coarser>, all_meshes, "half the phases");
  const auto enlarge = [&part](const Differences& differences, double weight) {
    for (const auto& [key, difference] : differences) {
      double& larger = part.at(key);
      if (!std::isnan(larger + difference)) larger = std::max(larger, weight * difference);
    }
  };
  // A largest value shows in none of these when it is at a phase that both keep.
  enlarge(comparison.differences(of_table<through_odd_phases>, all_meshes, "the other half of the phases"), 1);
  // Where slopes jump, the error is as large as the change by twice the distance between phases. That change may be
  // small by chance; the one by four times the distance then is not.
  if (divisible(4))
    enlarge(comparison.differences(of_table<much_coarser>, all_meshes, "a quarter of the phases"), 0.25);
  // Vibrations that are faster than the phases follow each other show in none of these.
  if (std::any_of(model.meshes.begin(), model.meshes.end(),
                  [](const TabulatedMesh& mesh) { return largest_jump(mesh.table, mesh.uptake) > smallest_jump; })) {
    enlarge(comparison.differences(jumps(JumpSide::stiffer), all_meshes, "early and long contact"), 1);
    enlarge(comparison.differences(jumps(JumpSide::softer), all_meshes, "late and short contact"), 1);
  }
  return part;
}

}  // namespace

ComparisonOptions comparison_options(const SteadyOutcome& nominal, const SimulationOptions& options) {
  ComparisonOptions result{.simulation = options};
  auto& o = result.simulation;
  if (nominal.periodic) o.samples_per_cycle = std::min(o.samples_per_cycle, enough_samples(nominal.window_cycles));
  o.estimate_error = false;
  o.keep_series = false;
  o.other_motions.starts = 0;  // all are compared on the nominal motion
  if (!o.mesh_cycles && (!nominal.periodic || !nominal.steady)) {
    // No steady state to compare, or one too long to integrate again and again: all are integrated in time over the
    // same length, from the nominal motion on, so that only the effect of the change has to settle.
    constexpr int lead = 60, evaluated = 110;
    o.integrate_for(lead, evaluated);
    o.start = nominal.begin;
    result.seeks_steady_state = false;
    return result;
  }
  const bool directly = taken_directly(nominal);
  o.confirmation = directly ? Confirmation::never : Confirmation::always;
  // A small change leads from the nominal motion to the one beside it within a few windows, and to no other.
  if (!directly && !o.mesh_cycles) {
    constexpr int few = 8;
    o.steady_state = SteadyState::time_integration;
    o.start = nominal.begin;
    o.max_windows = std::min(o.max_windows, few);
  }
  result.seeks_steady_state = !o.mesh_cycles;
  result.nominal_alike = !o.mesh_cycles && o.samples_per_cycle == options.samples_per_cycle &&
                         (o.steady_state == SteadyState::time_integration || nominal.total_cycles == 0);
  return result;
}

FigureSet propagate_errors(const Evaluation& nominal, const TabulatedModel& model) {
  Comparison comparison(nominal, model);
  std::vector<Differences> by_mesh;
  for (std::size_t i = 0; i < model.meshes.size(); ++i)
    by_mesh.push_back(any_error(model.meshes[i].table) ? stiffness_differences(comparison, model, i) : Differences{});
  const auto interpolation = interpolation_differences(comparison, model);

  FigureSet result;
  for (const auto& entry : nominal.figures.entries()) {
    if (entry.key == motions_key) {  // all others are on the nominal motion, and look for no other
      result.set(entry.key, entry.figure);
      continue;
    }
    ErrorParts parts;
    parts.integration = entry.figure.error;
    if (!model.meshes.empty()) parts.interpolation = interpolation.empty() ? not_known : interpolation.at(entry.key);
    for (std::size_t i = 0; i < by_mesh.size(); ++i)
      if (!by_mesh[i].empty())
        add_stiffness_error(by_mesh[i].at(entry.key), model.meshes[i].mean_stiffness_parts, parts);
    result.set(entry.key, {entry.figure.value, parts.total()}, parts);
  }
  widen_frequencies(result);
  return result;
}

}  // namespace annulus::dynamics
