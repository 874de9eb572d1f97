#include "app/systems/planetary/coupling_effect.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/results/content_id.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr int lead_cycles = 220, evaluated_cycles = 110;  // the start has decayed; two periods of 55-tooth planets

double largest_factor(const dynamics::MeshKindResult& kind) {
  double largest = 0;
  for (const auto& branch : kind.branches) largest = std::max(largest, branch.dynamic_factor_max.value);
  return largest;
}

}  // namespace

CouplingEffect coupling_effect(const dynamics::PlanetaryStage& uncoupled, const SolvedCoupling& solved,
                               const dynamics::SimulationOptions& options) {
  dynamics::SimulationOptions integrated = options;
  integrated.mesh_cycles = lead_cycles + evaluated_cycles;
  integrated.max_window_cycles = evaluated_cycles;
  integrated.estimate_error = false;
  integrated.keep_series = false;
  CouplingEffect effect;
  effect.cycles = evaluated_cycles;
  for (const auto model : {RimCoupling::none, RimCoupling::statical, RimCoupling::elastic}) {
    if (model == RimCoupling::elastic && solved.coupling.modes.empty()) continue;
    dynamics::PlanetaryStage stage = uncoupled;
    stage.ring_coupling = taken_coupling(solved, model);
    std::optional<dynamics::DynamicResponse> solved_response;
    try {
      solved_response = dynamics::simulate(stage, integrated);
    } catch (const SolverError& error) {
      // The comparison is an extra: where a model of it fails, the others stand.
      log::info(fmt::format("coupling through the ring, {}: {}",
                            model == RimCoupling::elastic ? "elastic modes" : "static", error.what()));
      continue;
    }
    const auto& response = *solved_response;
    const auto& sharing = response.sun_planet.load_sharing;
    effect.rows.push_back({model, sharing.averaged.value, sharing.instantaneous.value, sharing.quasi_static.value,
                           largest_factor(response.sun_planet), largest_factor(response.ring_planet)});
  }
  return effect;
}

void save(const CouplingEffect& effect, const std::string& id, const std::filesystem::path& folder) {
  Csv csv;
  csv.header = {{"annulus_version", version()},
                {"inputs_id", id},
                {"models", "0 none, 1 static, 2 elastic modes of the ring"},
                {"mesh_cycles", std::to_string(effect.cycles)}};
  csv.columns = {"model",
                 "sun_planet_load_sharing_averaged",
                 "sun_planet_load_sharing_instantaneous",
                 "sun_planet_load_sharing_quasi_static",
                 "sun_planet_dynamic_factor",
                 "ring_planet_dynamic_factor"};
  for (const auto& row : effect.rows) {
    const double model = row.model == RimCoupling::none ? 0 : row.model == RimCoupling::statical ? 1 : 2;
    csv.rows.push_back({model, row.averaged, row.instantaneous, row.quasi_static, row.sun_factor, row.ring_factor});
  }
  std::filesystem::create_directories(folder);
  csv.write(folder / effect_file);
}

CouplingEffect load_effect(const std::filesystem::path& folder) {
  const Csv csv = Csv::read(folder / effect_file);
  CouplingEffect effect;
  effect.cycles = std::stoi(csv.header.at(3).second);
  for (const auto& row : csv.rows) {
    const auto model = row[0] == 0 ? RimCoupling::none : row[0] == 1 ? RimCoupling::statical : RimCoupling::elastic;
    effect.rows.push_back({model, row[1], row[2], row[3], row[4], row[5]});
  }
  return effect;
}

}  // namespace annulus::app
