#include "app/stage/carried_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/errors.h"
#include "core/log.h"
#include "core/table_variants.h"

namespace annulus::app {

namespace {

using dynamics::DynamicResponse;
using dynamics::MeshKindResult;
using TableChange = StiffnessTable (*)(const StiffnessTable&);

/// Calls visit(figure, figure's errors) for every figure of one kind of mesh.
template <class Kind, class Errors, class Visit>
void for_each_figure(Kind& kind, Errors& errors, Visit visit) {
  visit(kind.load_sharing.instantaneous, errors.instantaneous);
  visit(kind.load_sharing.averaged, errors.averaged);
  visit(kind.load_sharing.quasi_static, errors.quasi_static);
  for (std::size_t n = 0; n < kind.branches.size(); ++n)
    visit(kind.branches[n].dynamic_factor_max, errors.dynamic_factor_max[n]);
}

/// Values of all figures, always in the same order.
std::vector<double> values_of(const DynamicResponse& response) {
  std::vector<double> values;
  for (const auto* kind : {&response.sun_planet, &response.ring_planet}) {
    const auto& sharing = kind->load_sharing;
    for (const auto* f : {&sharing.instantaneous, &sharing.averaged, &sharing.quasi_static}) values.push_back(f->value);
    for (const auto& b : kind->branches) values.push_back(b.dynamic_factor_max.value);
  }
  return values;
}

bool from_table(const dynamics::MeshExcitation& excitation) {
  return std::holds_alternative<dynamics::TableStiffness>(excitation);
}

bool any_error(const StiffnessTable& table) {
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase)
      for (int load = 0; load < static_cast<int>(table.loads().size()); ++load)
        if (table.at(position, phase, load).error_relative > 0) return true;
  return false;
}

constexpr TableChange unchanged = nullptr;

MeshResult with_table(const MeshResult& mesh, TableChange change) {
  MeshResult result = mesh;
  if (change) result.table = change(mesh.table);
  return result;
}

/// The harmonic balance is the motion to compare where it alone was asked, and where marching stayed on it.
bool taken_directly(const DynamicResponse& nominal) {
  return nominal.periodic && nominal.periodic->converged && (nominal.confirmed || nominal.total_cycles == 0);
}

/// How all stages of the comparison are solved.
dynamics::SimulationOptions comparing_options(const DynamicResponse& nominal, dynamics::SimulationOptions options) {
  if (nominal.periodic)
    options.samples_per_cycle = std::min(options.samples_per_cycle, dynamics::enough_samples(nominal.window_cycles));
  options.estimate_error = false;
  options.keep_series = false;
  if (!options.mesh_cycles && (!nominal.periodic || !nominal.steady)) {
    // No steady state to compare, or one too long to march through again and again: all marched alike for a while,
    // from the nominal motion on, so that only what the change does has to settle.
    constexpr int lead = 60, evaluated = 110;
    options.mesh_cycles = lead + evaluated;
    options.max_window_cycles = evaluated;
    options.start = nominal.begin;
    return options;
  }
  options.confirm = !taken_directly(nominal);
  // A small change leads from the nominal motion to the one beside it within a few windows, and to no other.
  if (options.confirm && !options.mesh_cycles) {
    constexpr int few = 8;
    options.steady_state = dynamics::SteadyState::time_integration;
    options.start = nominal.begin;
    options.max_windows = std::min(options.max_windows, few);
  }
  return options;
}

/// Solves the stage on changed tables.
class Comparison {
 public:
  Comparison(const DynamicResponse& nominal, const dynamics::SimulationOptions& options, const StageTables& tables)
      : options_(comparing_options(nominal, options)), tables_(tables), figures_(values_of(nominal).size()) {
    // Where the nominal motion was solved like those of the changed tables, it is what they are compared with.
    const bool marched = options_.steady_state == dynamics::SteadyState::time_integration;
    if (!options_.mesh_cycles && options_.samples_per_cycle == options.samples_per_cycle &&
        (marched || nominal.total_cycles == 0))
      base_ = Base{values_of(nominal), nominal.steady};
  }
  [[nodiscard]] std::size_t figures() const { return figures_; }

  /// |difference| of every figure to the unchanged tables.
  std::vector<double> differences(TableChange sun, TableChange ring, const std::string& what) {
    std::vector<double> result(figures_, std::numeric_limits<double>::quiet_NaN());
    try {
      if (!base_) {
        const auto response = solve(unchanged, unchanged);
        base_ = Base{values_of(response), response.steady};
      }
      const auto response = solve(sun, ring);
      // A change that ends the periodic motion has done so much at least.
      if (!options_.mesh_cycles && base_->steady && !response.steady)
        log::warn(fmt::format("no steady state with {}: the figures of its last mesh cycles are compared", what));
      const auto values = values_of(response);
      for (std::size_t i = 0; i < figures_; ++i) result[i] = std::abs(values[i] - base_->values[i]);
    } catch (const Error& error) {  // no solution, or a changed table from which no law follows
      log::warn(fmt::format("{}: {}: what it does to the figures is not known", what, error.what()));
    }
    return result;
  }

 private:
  struct Base {
    std::vector<double> values;
    bool steady = false;
  };
  DynamicResponse solve(TableChange sun, TableChange ring) const {
    return dynamics::simulate(tables_.make(with_table(tables_.sun_mesh, sun), with_table(tables_.ring_mesh, ring)),
                              options_);
  }

  dynamics::SimulationOptions options_;
  const StageTables& tables_;
  std::size_t figures_;
  std::optional<Base> base_;
};

/// The larger one; NaN when one is.
double worse_of(double a, double b) { return std::isnan(a + b) ? a + b : std::max(a, b); }

/// What the error estimate of one mesh's stiffness does to every figure.
std::vector<double> stiffness_part(Comparison& comparison, bool of_sun) {
  const auto changes = [&](TableChange change, const char* what) {
    const std::string text = fmt::format("{} in the {} mesh", what, of_sun ? "sun" : "ring");
    return of_sun ? comparison.differences(change, unchanged, text) : comparison.differences(unchanged, change, text);
  };
  auto part = changes(stiffer, "more stiffness");
  const auto ripple = changes(more_rippled, "more ripple");
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = worse_of(part[i], ripple[i]);
  return part;
}

/// Adds the error a figure has by a mesh's stiffness, in the proportions of that stiffness' own error.
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

std::vector<double> interpolation_part(Comparison& comparison, const StiffnessTable* sun, const StiffnessTable* ring) {
  std::vector<double> part(comparison.figures(), 0.0);
  if (!sun && !ring) return part;
  const auto odd = [](const StiffnessTable* table) { return table && table->phases() % 2 != 0; };
  if (odd(sun) || odd(ring)) {
    std::fill(part.begin(), part.end(), std::numeric_limits<double>::quiet_NaN());
    return part;
  }
  part = comparison.differences(sun ? &coarser : unchanged, ring ? &coarser : unchanged, "half the phases");
  // Between the first order of jumping slopes and the second of smooth curves: halving the spacing leaves a third to a
  // half of what halving the number did.
  for (double& x : part) x /= 2;
  return part;
}

}  // namespace

ResponseErrors carried_errors(const DynamicResponse& nominal, const dynamics::SimulationOptions& options,
                              const StageTables& tables) {
  const auto stage = tables.make(tables.sun_mesh, tables.ring_mesh);
  const bool sun = from_table(stage.sun_mesh), ring = from_table(stage.ring_mesh);
  const auto &sun_table = tables.sun_mesh.table, &ring_table = tables.ring_mesh.table;
  Comparison comparison(nominal, options, tables);
  const bool sun_errs = sun && any_error(sun_table), ring_errs = ring && any_error(ring_table);
  const auto by_sun = sun_errs ? stiffness_part(comparison, true) : std::vector<double>(comparison.figures(), 0.0);
  const auto by_ring = ring_errs ? stiffness_part(comparison, false) : std::vector<double>(comparison.figures(), 0.0);
  const auto interpolation = interpolation_part(comparison, sun ? &sun_table : nullptr, ring ? &ring_table : nullptr);
  const auto of_sun = tables.sun_mesh.mean_stiffness().parts, of_ring = tables.ring_mesh.mean_stiffness().parts;

  ResponseErrors errors;
  std::size_t i = 0;
  const auto put = [&](const MeshKindResult& kind, MeshKindErrors& into) {
    into.dynamic_factor_max.resize(kind.branches.size());
    for_each_figure(kind, into, [&](const Figure& f, ErrorParts& e) {
      e = {};
      e.integration = f.error;
      e.interpolation = interpolation[i];
      if (sun_errs) add_stiffness_error(by_sun[i], of_sun, e);
      if (ring_errs) add_stiffness_error(by_ring[i], of_ring, e);
      ++i;
    });
  };
  put(nominal.sun_planet, errors.sun_planet);
  put(nominal.ring_planet, errors.ring_planet);
  return errors;
}

void set_errors(const ResponseErrors& errors, DynamicResponse& response) {
  const auto set = [](Figure& f, const ErrorParts& e) { f.error = e.total(); };
  for_each_figure(response.sun_planet, errors.sun_planet, set);
  for_each_figure(response.ring_planet, errors.ring_planet, set);
}

}  // namespace annulus::app
