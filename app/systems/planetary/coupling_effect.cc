#include "app/systems/planetary/coupling_effect.h"

#include <fmt/format.h>

#include <utility>

#include "app/results/content_id.h"
#include "app/systems/planetary/planetary_input.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/log.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

constexpr int lead_cycles = 220, evaluated_cycles = 110;  // the start has decayed; two periods of 55-tooth planets
constexpr double longest = 10;                            // s, of one model: the comparison is an extra

using Row = CouplingEffect::Row;

/// The values of a row by the keys of dynamics::planetary_figures, which are its columns too.
constexpr std::pair<const char*, double Row::*> row_values[] = {
    {"sun_planet_load_sharing_averaged", &Row::averaged},
    {"sun_planet_load_sharing_instantaneous", &Row::instantaneous},
    {"sun_planet_load_sharing_quasi_static", &Row::quasi_static},
    {"sun_planet_peak_factor", &Row::sun_factor},
    {"ring_planet_peak_factor", &Row::ring_factor}};

}  // namespace

CouplingEffect coupling_effect(const dynamics::PlanetaryStage& uncoupled, const SolvedCoupling& solved,
                               const dynamics::SimulationOptions& options) {
  dynamics::SimulationOptions integrated = options;
  integrated.integrate_for(lead_cycles, evaluated_cycles);
  CouplingEffect effect;
  effect.cycles = evaluated_cycles;
  for (const auto model : {RimCoupling::none, RimCoupling::statical, RimCoupling::elastic}) {
    // The modes of a ring that turns are not modelled.
    if (model == RimCoupling::elastic && (solved.coupling.modes.empty() || uncoupled.ring_speed != 0)) continue;
    const char* name = model == RimCoupling::elastic ? "elastic modes" : model == RimCoupling::none ? "none" : "static";
    dynamics::PlanetaryStage stage = uncoupled;
    stage.ring_coupling = taken_coupling(solved, model);
    const double seconds =
        dynamics::integration_seconds(assemble(stage), stage.mesh_frequency(), lead_cycles + evaluated_cycles,
                                      integrated.integrator, dynamics::StiffnessCourse::sudden);
    if (!(seconds <= longest)) {
      log::info(
          fmt::format("coupling through the ring, {}: not compared, it would take about {:.0f} s", name, seconds));
      continue;
    }
    try {
      const auto figures = dynamics::figures(dynamics::simulate(stage, integrated));
      auto& row = effect.rows.emplace_back(Row{.model = model});
      for (const auto& [key, value] : row_values) row.*value = figures.value(key);
    } catch (const Error& error) {
      // The comparison is an extra: where a model of it fails, the others stand.
      log::info(fmt::format("coupling through the ring, {}: {}", name, error.what()));
    }
  }
  return effect;
}

void save(const CouplingEffect& effect, const std::string& id, const std::filesystem::path& folder) {
  Csv csv;
  csv.header = {{"annulus_version", version()},
                {"inputs_id", id},
                {"models", "0 none, 1 static, 2 elastic modes of the ring"},
                {"mesh_cycles", std::to_string(effect.cycles)}};
  csv.columns = {"model"};
  for (const auto& [key, value] : row_values) csv.columns.emplace_back(key);
  for (const auto& row : effect.rows) {
    auto& cells = csv.rows.emplace_back(1, row.model == RimCoupling::none       ? 0
                                           : row.model == RimCoupling::statical ? 1
                                                                                : 2);
    for (const auto& [key, value] : row_values) cells.push_back(row.*value);
  }
  std::filesystem::create_directories(folder);
  csv.write(folder / effect_file);
}

}  // namespace annulus::app
