#include "app/pair/pair_table_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/errors.h"
#include "core/log.h"
#include "core/table_variants.h"

namespace annulus::app {

namespace {

using PairFigures = std::vector<Figure*>;

PairFigures figures_of(dynamics::PairResponse& r) {
  auto& a = r.acceleration;
  PairFigures list = {&r.force_max, &r.force_min, &r.dynamic_factor, &a.line_of_action,
                      &a.axial,     &a.rotation,  &a.tooth};
  for (auto* motions : {&r.dynamic, &r.quasi_static}) {
    for (auto* m : {&motions->transmission_error, &motions->relative}) {
      list.push_back(&m->peak_to_peak);
      list.push_back(&m->largest);
    }
  }
  return list;
}

bool has_estimate(const StiffnessTable& table) {
  for (int phase = 0; phase < table.phases(); ++phase) {
    for (int load = 0; load < static_cast<int>(table.loads().size()); ++load) {
      if (table.at(0, phase, load).error_relative > 0) return true;
    }
  }
  return false;
}

}  // namespace

void add_table_errors(const PairRunResult& result, dynamics::PairResponse& response) {
  if (!result.mesh.table) return;
  const auto& table = *result.mesh.table;
  auto simulation = pair_simulation(result.scene);
  simulation.confirm = simulation.keep_series = simulation.estimate_error = false;
  const auto solve = [&](const StiffnessTable& changed) {
    PairMesh mesh = result.mesh;
    mesh.table = changed;
    auto pair = *result.pair;
    pair.mesh = pair_excitation(result.scene, result.geometry, mesh);
    return dynamics::evaluate_pair(pair, simulation);
  };
  const auto figures = figures_of(response);
  std::vector<double> stiffness(figures.size(), 0.0), phases(figures.size(), 0.0);
  const auto compare = [&](std::vector<double>& part, StiffnessTable (*change)(const StiffnessTable&), double weight) {
    try {
      auto base = solve(table), other = solve(change(table));
      const auto a = figures_of(base), b = figures_of(other);
      for (std::size_t i = 0; i < part.size(); ++i)
        part[i] = std::isnan(part[i]) ? part[i] : std::max(part[i], weight * std::abs(a[i]->value - b[i]->value));
    } catch (const Error& error) {
      log::warn(std::string("what the error of the table does to the figures is not known: ") + error.what());
      std::fill(part.begin(), part.end(), std::numeric_limits<double>::quiet_NaN());
    }
  };
  if (has_estimate(table)) {
    compare(stiffness, stiffer, 1);
    compare(stiffness, more_rippled, 1);
  }
  compare(phases, coarser, 1.0 / 3);
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i]->error += stiffness[i] + phases[i];
}

}  // namespace annulus::app
