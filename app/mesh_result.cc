#include "app/mesh_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/content_id.h"
#include "app/svg_mesh.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

std::size_t most_pairs(const fem::LoadedMeshResult& solved) {
  std::size_t pairs = 0;
  for (const auto& p : solved.positions) pairs = std::max(pairs, p.pair_share.size());
  return pairs;
}

Csv position_table(const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase",
                 "ring_tooth",
                 "ring_angle_deg",
                 "load_N",
                 "unloaded_te_um",
                 "lte_um",
                 "error_um",
                 "max_pressure_MPa",
                 "tip_edge_contact",
                 "force_balance_relative",
                 "energy_balance_relative",
                 "max_penetration_um"};
  const std::size_t pairs = most_pairs(solved);
  for (std::size_t i = 1; i <= pairs; ++i) {
    csv.columns.push_back(fmt::format("pair{}_roll_mm", i));
    csv.columns.push_back(fmt::format("pair{}_share", i));
  }
  for (const auto& p : solved.positions) {
    const double deflection = p.entry.lte - p.entry.unloaded_te;
    std::vector<double> row = {p.mesh_phase,
                               static_cast<double>(p.ring_tooth),
                               p.ring_angle / units::deg,
                               p.load,
                               p.entry.unloaded_te / units::um,
                               p.entry.lte / units::um,
                               std::abs(p.entry.error_relative * deflection) / units::um,
                               p.max_pressure / 1e6,
                               p.tip_edge_contact ? 1.0 : 0.0,
                               p.force_balance_relative,
                               p.energy_balance_relative,
                               p.max_penetration / units::um};
    for (std::size_t i = 0; i < pairs; ++i) {
      const bool there = i < p.pair_share.size() && i < p.pair_roll.size();
      row.push_back(there ? p.pair_roll[i] / units::mm : not_known);
      row.push_back(there ? p.pair_share[i] : 0);
    }
    csv.rows.push_back(std::move(row));
  }
  return csv;
}

Csv pin_table(const fem::LoadedMeshResult& solved, double nominal_load) {
  Csv csv;
  csv.columns = {"mesh_phase", "ring_tooth",     "ring_angle_deg",    "pin",
                 "touching",   "radial_force_N", "tangential_force_N"};
  for (const auto& p : solved.positions) {
    if (p.load != nominal_load) continue;
    for (std::size_t i = 0; i < p.pins.size(); ++i) {
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), p.ring_angle / units::deg,
                          static_cast<double>(i + 1), p.pins[i].touching ? 1.0 : 0.0, p.pins[i].radial_force,
                          p.pins[i].tangential_force});
    }
  }
  return csv;
}

std::map<std::string, double> facts_of(const fem::LoadedMeshResult& solved) {
  std::map<std::string, double> facts = {
      {"closure_relative", solved.closure_relative},
      {"reciprocity_relative", solved.reciprocity_relative},
      {"level", solved.level},
      {"worst_error_relative", solved.worst_error_relative},
      {"unknowns", static_cast<double>(solved.unknowns)},
      {"worst_scaled_jacobian",
       std::min(solved.planet_sector.worst_scaled_jacobian(), solved.wheel_sector.worst_scaled_jacobian())},
      {"mesh_seconds", solved.mesh_seconds},
      {"condense_seconds", solved.condense_seconds},
      {"contact_seconds", solved.contact_seconds}};
  auto& force = facts["force_balance_relative"];
  auto& energy = facts["energy_balance_relative"];
  auto& penetration = facts["max_penetration_m"];
  for (const auto& p : solved.positions) {
    force = std::max(force, p.force_balance_relative);
    energy = std::max(energy, p.energy_balance_relative);
    penetration = std::max(penetration, p.max_penetration);
  }
  if (solved.pin_stiffness > 0) facts["pin_stiffness_N_per_m"] = solved.pin_stiffness;
  return facts;
}

template <class Visit>
void at_load(const StiffnessTable& table, std::size_t load, Visit visit) {
  for (int position = 0; position < table.positions(); ++position) {
    for (int phase = 0; phase < table.phases(); ++phase) visit(table.at(position, phase, static_cast<int>(load)));
  }
}

}  // namespace

Estimate MeshResult::mean_stiffness() const {
  double sum = 0, error = 0;
  at_load(table, nominal, [&](const StiffnessEntry& e) {
    sum += e.stiffness_secant;
    error += e.error_relative * e.stiffness_secant;
  });
  return {sum / (table.positions() * table.phases()), error / sum};
}

Estimate MeshResult::lte_mean() const {
  double sum = 0, error = 0;
  at_load(table, nominal, [&](const StiffnessEntry& e) {
    sum += e.lte;
    error += std::abs(e.error_relative * (e.lte - e.unloaded_te));
  });
  return {sum / (table.positions() * table.phases()), error / std::abs(sum)};
}

Estimate MeshResult::lte_peak_to_peak() const {
  const StiffnessEntry *low = nullptr, *high = nullptr;
  at_load(table, nominal, [&](const StiffnessEntry& e) {
    if (!low || e.lte < low->lte) low = &e;
    if (!high || e.lte > high->lte) high = &e;
  });
  const double range = high->lte - low->lte;
  if (range <= 0) return {range, 0};
  // The discretisation shifts all positions alike; on the range acts the difference of the errors at its two ends, and
  // at least the same relative error as on the mean. An estimate, not a bound.
  const double difference = std::abs(high->error_relative * (high->lte - high->unloaded_te) -
                                     low->error_relative * (low->lte - low->unloaded_te));
  return {range, std::max(difference / range, lte_mean().error_relative)};
}

double MeshResult::fact(const std::string& name) const {
  const auto found = facts.find(name);
  return found == facts.end() ? not_known : found->second;
}

MeshResult pack(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  MeshResult result{.model = model,
                    .contact_ratio = model.problem->pair.contact_ratio(),
                    .table = solved.table,
                    .positions = position_table(solved),
                    .facts = facts_of(solved),
                    .nominal = nominal_load_index};
  result.pins = pin_table(solved, model.problem->loads[nominal_load_index]);
  result.picture = mesh_picture(*model.problem, solved, model.mesh + "-" + model.ring);
  result.table.provenance = {{"annulus_version", version()}, {"inputs_id", model.id()}, {"rung", model.rung}};
  return result;
}

void save(const MeshResult& result, const std::filesystem::path& folder) {
  const auto& mesh = result.model.mesh;
  std::filesystem::create_directories(folder / "mesh");
  const std::string id = result.model.id();
  const auto stamp = [&](Csv csv) {
    csv.header.insert(csv.header.begin(),
                      {{"annulus_version", version()}, {"inputs_id", id}, {"mesh", mesh}, {"rung", result.model.rung}});
    return csv;
  };
  if (!result.positions.rows.empty()) {
    Csv csv = result.positions;
    csv.header.clear();
    csv.header.emplace_back("contact_ratio", fmt::format("{:.17g}", result.contact_ratio));
    for (const auto& [name, value] : result.facts) csv.header.emplace_back(name, fmt::format("{:.17g}", value));
    stamp(csv).write(folder / ("lte_" + mesh + ".csv"));
  }
  if (!result.pins.rows.empty()) {
    Csv csv = result.pins;
    csv.header.clear();
    stamp(csv).write(folder / ("pins_" + mesh + ".csv"));
  }
  if (!result.picture.empty()) write_file(folder / "mesh" / (mesh + ".svg"), result.picture);
  // Written last: its presence says that the others are complete.
  result.table.write_csv(folder / ("stiffness_" + mesh + ".csv"));
}

}  // namespace annulus::app
