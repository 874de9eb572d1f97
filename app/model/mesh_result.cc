#include "app/model/mesh_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "app/model/mesh_tables.h"
#include "app/report/drawings/mesh.h"
#include "app/results/content_id.h"
#include "core/errors.h"
#include "core/file_guard.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// A closed form needs no mesh.
bool has_mesh(const fem::LoadedMeshResult& solved) { return !solved.wheel_sector.cells.empty(); }

std::map<std::string, double> facts_of(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  std::map<std::string, double> facts = {{"closure_relative", solved.closure_relative},
                                         {"reciprocity_relative", solved.reciprocity_relative},
                                         {"level", solved.level},
                                         {"degree", solved.degree},
                                         {"worst_error_relative", solved.worst_error_relative},
                                         {"unknowns", static_cast<double>(solved.unknowns)},
                                         {"mesh_seconds", solved.mesh_seconds},
                                         {"condense_seconds", solved.condense_seconds},
                                         {"contact_seconds", solved.contact_seconds},
                                         {"condensed_teeth", solved.condensed_teeth},
                                         {"reused_teeth", solved.reused_teeth},
                                         {"processor_seconds", solved.processor_seconds}};
  auto& force = facts["force_balance_relative"];
  auto& energy = facts["energy_balance_relative"];
  auto& penetration = facts["max_penetration_m"];
  for (const auto& p : solved.positions) {
    force = std::max(force, p.force_balance_relative);
    energy = std::max(energy, p.energy_balance_relative);
    penetration = std::max(penetration, p.max_penetration);
  }
  if (has_mesh(solved)) {
    facts["worst_scaled_jacobian"] =
        std::min(solved.pinion_sector.worst_scaled_jacobian(), solved.wheel_sector.worst_scaled_jacobian());
  }
  for (const auto& [body, stress, errors] :
       {std::tuple{model.pinion_body, &fem::LoadedPosition::pinion_stress, &solved.pinion_stress_error},
        {model.wheel_body, &fem::LoadedPosition::wheel_stress, &solved.wheel_stress_error}})
    if (std::any_of(solved.positions.begin(), solved.positions.end(),
                    [m = stress](const fem::LoadedPosition& p) { return (p.*m).has_value(); }))
      for (const auto& [name, value] : stress_columns) facts[stress_error_fact(body, name)] = errors->*value;
  if (over_face_width(solved)) facts[face_load_factor_error] = solved.face_load_factor_error;
  if (solved.pin_stiffness > 0) facts["pin_stiffness_N_per_m"] = solved.pin_stiffness;
  return facts;
}

constexpr const char* course_of_solve[] = {"mesh_seconds",      "condense_seconds", "contact_seconds",
                                           "processor_seconds", "condensed_teeth",  "reused_teeth"};

template <class Visit>
void at_load(const StiffnessTable& table, std::size_t load, Visit visit) {
  for (int position = 0; position < table.positions(); ++position) {
    for (int phase = 0; phase < table.phases(); ++phase) visit(table.at(position, phase, static_cast<int>(load)));
  }
}

/// Whether a curve jumps between two samples, from its steps before, between and after them.
bool jumps(double before, double step, double after) { return std::abs(step) > std::abs(before) + std::abs(after); }

/// What the mean of equidistant samples of a periodic curve may miss between them: the largest difference to the mean
/// of every second one, or half of that of every fourth one, which a chance agreement hides less, or what jumps of the
/// curve leave open. The mean of a curve that jumps converges with the first order, so the halved distance leaves as
/// much as it changed.
double between_samples(const std::vector<double>& values) {
  const auto mean_of = [&](std::size_t first, std::size_t step) {
    double sum = 0;
    for (std::size_t i = first; i < values.size(); i += step) sum += values[i];
    return sum * static_cast<double>(step) / static_cast<double>(values.size());
  };
  const double mean = mean_of(0, 1);
  double missed = 0;
  for (const std::size_t step : {2, 4}) {
    if (values.size() % step != 0) break;
    for (std::size_t first = 0; first < step; ++first)
      missed = std::max(missed, std::abs(mean_of(first, step) - mean) * 2 / static_cast<double>(step));
  }
  // Where in its interval a jump lies is not known: half of it times the interval, and several add up.
  const std::size_t n = values.size();
  double jumped = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = values[i] - values[(i + n - 1) % n], step = values[(i + 1) % n] - values[i],
                 after = values[(i + 2) % n] - values[(i + 1) % n];
    if (jumps(before, step, after)) jumped += std::abs(step);
  }
  return std::max(missed, jumped / 2 / static_cast<double>(n));
}

/// Adds what lies between the positions of a table to the errors of a mean; a prescribed wave has none.
Estimate with_interpolation(Estimate mean, const MeshResult& mesh, double (*quantity)(const StiffnessEntry&)) {
  if (!mesh.tabulated || mean.value == 0) return mean;
  std::vector<double> values;
  at_load(mesh.table, mesh.nominal, [&](const StiffnessEntry& e) { values.push_back(quantity(e)); });
  mean.parts.interpolation = between_samples(values) / std::abs(mean.value);
  mean.error_relative += mean.parts.interpolation;
  return mean;
}

/// The mean of a stiffness over the table at the nominal load; the relative errors are those of the secant.
template <double StiffnessEntry::*stiffness>
Estimate mean_of(const MeshResult& mesh) {
  double sum = 0, error = 0;
  ErrorParts parts;
  at_load(mesh.table, mesh.nominal, [&](const StiffnessEntry& e) {
    sum += e.*stiffness;
    error += e.error_relative * e.*stiffness;
    parts += e.*stiffness * e.error_parts;
  });
  return with_interpolation({sum / (mesh.table.positions() * mesh.table.phases()), error / sum, (1 / sum) * parts},
                            mesh, [](const StiffnessEntry& e) { return e.*stiffness; });
}

}  // namespace

Estimate MeshResult::mean_stiffness() const { return mean_of<&StiffnessEntry::stiffness_secant>(*this); }

Estimate MeshResult::mean_tangent() const { return mean_of<&StiffnessEntry::stiffness_tangent>(*this); }

double MeshResult::worst_stiffness_error() const {
  double worst = 0;
  at_load(table, nominal, [&](const StiffnessEntry& e) { worst = std::max(worst, e.error_relative); });
  return worst;
}

Estimate MeshResult::lte_mean() const {
  double sum = 0, error = 0;
  ErrorParts parts;
  at_load(table, nominal, [&](const StiffnessEntry& e) {
    const double deflection = std::abs(e.lte - e.unloaded_te);
    sum += e.lte;
    error += e.error_relative * deflection;
    parts += deflection * e.error_parts;
  });
  return with_interpolation(
      {sum / (table.positions() * table.phases()), error / std::abs(sum), (1 / std::abs(sum)) * parts}, *this,
      [](const StiffnessEntry& e) { return e.lte; });
}

namespace {

/// How far a curve sampled at equal steps and closed on itself may reach beyond its highest sample. A kink between two
/// samples lies near where the lines through the neighbours on either side meet, a smooth top below the half of it; a
/// branch that ends in a jump goes on up to there. Branches that grow steeper towards it go on doing so.
double beyond_the_highest(const std::vector<double>& values) {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  if (n < 4) return 0;
  const auto at = [&](std::ptrdiff_t i) { return values[static_cast<std::size_t>((i % n + n) % n)]; };
  const double highest = *std::max_element(values.begin(), values.end());
  double reach = 0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    // Between samples i and i + 1: rising with the slope before, falling with the slope after.
    const double rise = at(i) - at(i - 1), fall = at(i + 1) - at(i + 2), step = at(i + 1) - at(i);
    const double up = rise + std::max(0.0, rise - (at(i - 1) - at(i - 2))),
                 down = fall + std::max(0.0, fall - (at(i + 2) - at(i + 3)));
    if (jumps(rise, step, fall)) {
      reach = std::max(reach, std::max(at(i) + std::max(up, 0.0), at(i + 1) + std::max(down, 0.0)) - highest);
    } else if (rise > 0 && fall > 0) {
      const double place = (step + down) / (up + down);  // in steps from i
      reach = std::max(reach, at(i) + up * std::clamp(place, 0.0, 1.0) - highest);
    }
  }
  return reach;
}

/// Largest less smallest value over the table at the nominal load, and its error. The discretisation shifts all
/// positions alike; on the range acts the difference of the errors (`error_of`) at its two ends, and at least the same
/// relative error as on the mean. An estimate, not a bound.
template <class ValueOf, class ErrorOf>
Estimate range_of(const MeshResult& mesh, const Estimate& mean, ValueOf value_of, ErrorOf error_of) {
  const StiffnessEntry *low = nullptr, *high = nullptr;
  std::vector<double> up, down;
  at_load(mesh.table, mesh.nominal, [&](const StiffnessEntry& e) {
    if (!low || value_of(e) < value_of(*low)) low = &e;
    if (!high || value_of(e) > value_of(*high)) high = &e;
    up.push_back(value_of(e));
    down.push_back(-value_of(e));
  });
  const double range = value_of(*high) - value_of(*low);
  if (range <= 0) return {range, 0};
  const double difference = std::abs(error_of(*high) - error_of(*low));
  const double missed = beyond_the_highest(up) + beyond_the_highest(down);
  const double of_mean = mean.error_relative - mean.parts.interpolation;
  const double of_stiffness = std::max(difference / range, of_mean);
  ErrorParts parts;
  if (of_mean > 0) parts = (of_stiffness / of_mean) * mean.parts;
  parts.interpolation = missed / range;
  return {range, of_stiffness + missed / range, parts};
}

}  // namespace

Estimate MeshResult::lte_peak_to_peak() const {
  return range_of(
      *this, lte_mean(), [](const StiffnessEntry& e) { return e.lte; },
      [](const StiffnessEntry& e) { return e.error_relative * (e.lte - e.unloaded_te); });
}

Estimate MeshResult::stiffness_ripple() const {
  const auto mean = mean_stiffness();
  auto range = range_of(
      *this, mean, [](const StiffnessEntry& e) { return e.stiffness_secant; },
      [](const StiffnessEntry& e) { return e.error_relative * e.stiffness_secant; });
  range.value /= mean.value;
  return range;
}

double MeshResult::fact(const std::string& name) const {
  const auto found = facts.find(name);
  return found == facts.end() ? not_known : found->second;
}

std::optional<Estimate> MeshResult::largest(const std::string& column, double discretisation) const {
  const auto found = peak(column);
  if (!found || !std::isfinite(found->value) || found->value == 0) return std::nullopt;
  const double sign = found->value < 0 ? -1 : 1, size = std::abs(found->value);
  const auto value = positions.column(column), load = positions.column("load_N"),
             phase = positions.column("mesh_phase");
  std::vector<double> values;  // in the order of the mesh cycles
  for (const auto& row : positions.rows)
    if (row[load] == table.loads()[nominal] && row[phase] < 1) values.push_back(sign * row[value]);
  Estimate result{found->value, 0, {}};
  result.parts.discretisation = discretisation / size;
  result.parts.interpolation = beyond_the_highest(values) / size;
  result.error_relative = result.parts.total();
  return result;
}

std::optional<Estimate> MeshResult::largest_stress(const std::string& body, const std::string& kind) const {
  auto result = largest(fmt::format("{}_{}_MPa", body, kind), fact(stress_error_fact(body, kind)) / 1e6);
  if (!result) return std::nullopt;
  result->value *= 1e6;
  result->parts.model = mean_stiffness().parts.model;  // plane strain in a face of finite width changes both
  result->error_relative = result->parts.total();
  return result;
}

std::optional<Estimate> MeshResult::face_load_factor() const {
  return largest("face_load_factor", fact(face_load_factor_error));
}

std::optional<Peak> MeshResult::peak(const std::string& column) const {
  if (std::find(positions.columns.begin(), positions.columns.end(), column) == positions.columns.end())
    return std::nullopt;
  const auto value = positions.column(column), load = positions.column("load_N"),
             phase = positions.column("mesh_phase"), tooth = positions.column("ring_tooth");
  std::optional<Peak> best;
  for (const auto& row : positions.rows) {
    // The closure position at phase 1 repeats the one at phase 0.
    if (row[load] != table.loads()[nominal] || row[phase] >= 1 || !std::isfinite(row[value])) continue;
    if (!best || std::abs(row[value]) > std::abs(best->value))
      best = Peak{row[value], {row[phase], static_cast<int>(row[tooth])}};
  }
  return best;
}

MeshResult stiffness_alone(const MeshResult& mesh) {
  return {.model = mesh.model,
          .contact_ratio = mesh.contact_ratio,
          .table = mesh.table,
          .facts = mesh.facts,
          .coupling = mesh.coupling,
          .face = mesh.face,
          .shares = mesh.shares,
          .partner_compliance = mesh.partner_compliance,
          .nominal = mesh.nominal,
          .tabulated = mesh.tabulated,
          .reused = mesh.reused};
}

namespace {

PairShares shares_of(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  const auto& pair = model.problem->pair;
  const double pitch = pair.pinion().base_pitch(), nominal = model.problem->loads[model.nominal_load()];
  const double direction = pair.driver() == geometry::GearRole::pinion ? 1 : -1;
  PairShares shares;
  shares.phases = solved.table.phases();
  std::vector<std::map<int, double>> sums(static_cast<std::size_t>(shares.phases));
  int last = 0;
  for (const auto& p : solved.positions) {
    if (p.load != nominal || p.mesh_phase >= 1) continue;
    auto& at = sums.at(static_cast<std::size_t>(std::lround(p.mesh_phase * shares.phases)));
    for (std::size_t i = 0; i < p.pair_share.size(); ++i) {
      if (!(p.pair_share[i] > 0)) continue;
      // Later pairs stand where the contact comes from.
      const double behind = (pair.roll_length_pitch() - p.pair_roll.at(i)) / pitch * direction + p.mesh_phase;
      const int later = static_cast<int>(std::lround(behind));
      at[later] += p.pair_share[i];
      shares.first = std::min(shares.first, later);
      last = std::max(last, later);
    }
  }
  for (const auto& at : sums) {
    double sum = 0;
    for (const auto& [later, share] : at) sum += share;
    require(sum > 0, fmt::format("the tooth pairs of the {} carry nothing at a position", model.label()));
    auto& list = shares.share.emplace_back(static_cast<std::size_t>(last - shares.first + 1), 0.0);
    for (const auto& [later, share] : at) list[static_cast<std::size_t>(later - shares.first)] = share / sum;
  }
  return shares;
}

std::vector<double> partner_compliance_of(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  if (!model.problem->planet_rollers) return {};
  const int phases = solved.table.phases();
  const double nominal = model.problem->loads[model.nominal_load()];
  std::vector<double> sum(static_cast<std::size_t>(phases), 0.0);
  for (const auto& p : solved.positions)
    if (p.load == nominal && p.mesh_phase < 1)
      sum.at(static_cast<std::size_t>(std::lround(p.mesh_phase * phases))) += p.partner_compliance;
  for (double& compliance : sum) compliance /= solved.table.positions();
  return sum;
}

}  // namespace

void leave_out_course_of_solve(MeshResult& result) {
  for (const char* name : course_of_solve) result.facts.erase(name);
}

MeshResult pack(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  MeshResult result{.model = model,
                    .contact_ratio = model.problem->pair.contact_ratio(),
                    .table = solved.table,
                    .positions = position_table(model, solved),
                    .housing = housing_table(model, solved),
                    .rollers = roller_table(model, solved),
                    .pins = pin_table(model, solved),
                    .pressure = pressure_table(model, solved),
                    .line_load = line_load_table(model, solved),
                    .stress = stress_table(model, solved),
                    .gauges = gauge_table(solved),
                    .facts = facts_of(model, solved),
                    .shares = shares_of(model, solved),
                    .partner_compliance = partner_compliance_of(model, solved),
                    .nominal = model.nominal_load()};
  const std::vector<std::string> keys = {"load_N", "mesh_phase"};  // by which rows are found
  result.positions.round(keys);
  for (const auto& [name, member] : side_tables) (result.*member).round(keys);
  if (has_mesh(solved)) result.picture = mesh_picture(*model.problem, solved, model.mesh + "-" + model.variant);
  if (solved.fields.size() == 2) {  // the pinion's, then the wheel's
    const auto& pinion = solved.fields.front();
    result.fields.push_back(deformed_mesh(pinion, solved.fields.back(), solved.positions[pinion.position],
                                          model.problem->pair, model.pinion_body + " and " + model.wheel_body));
  }
  result.table.provenance = {{"annulus_version", version()}, {"inputs_id", model.id()}, {"model", model.fidelity}};
  return result;
}

void save(const MeshResult& result, const std::filesystem::path& folder) {
  const auto& mesh = result.model.mesh;
  std::filesystem::create_directories(folder / "mesh");
  const std::string id = result.model.id();
  // An empty table leaves no file behind, not even one of an earlier run.
  const auto keep = [&](const std::string& name, Csv csv) {
    const auto file = folder / (name + "_" + mesh + ".csv");
    if (csv.rows.empty()) return remove_file(file);
    csv.header.insert(
        csv.header.begin(),
        {{"annulus_version", version()}, {"inputs_id", id}, {"mesh", mesh}, {"model", result.model.fidelity}});
    csv.write(file);
  };
  Csv positions = result.positions;
  positions.header = {{"contact_ratio", fmt::format("{:.17g}", result.contact_ratio)}};
  for (const auto& [name, value] : result.facts) positions.header.emplace_back(name, fmt::format("{:.17g}", value));
  keep("lte", std::move(positions));
  for (const auto& [name, member] : side_tables) keep(name, result.*member);
  auto files = result.bodies;
  files[mesh + ".svg"] = result.picture.empty() ? std::nullopt : std::optional(result.picture);
  write_files(files, folder / "mesh");
  result.table.write_csv(folder / ("stiffness_" + mesh + ".csv"));
}

}  // namespace annulus::app
