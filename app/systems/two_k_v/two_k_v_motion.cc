#include "app/systems/two_k_v/two_k_v_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/model/table_errors.h"
#include "app/model/time_series.h"
#include "app/results/content_id.h"
#include "app/systems/shared/mesh_names.h"
#include "core/files.h"
#include "core/json.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

namespace {

constexpr double highest_crank_order = 200;  // several multiples of both mesh orders

Json meshes_json(const std::vector<dynamics::BranchResult>& meshes) {
  auto json = Json::array();
  for (const auto& m : meshes)
    json.push_back({{"peak_factor", to_json(m.peak_factor)},
                    {"dynamic_factor", to_json(m.dynamic_factor)},
                    {"smallest_factor", m.smallest_factor},
                    {"mean_force_N", m.mean_force},
                    {"contact_loss", to_json(m.contact_loss)}});
  return json;
}

Json motion_json(const TwoKVMotion& m, const std::string& id) {
  Json json = {{"inputs_id", id},
               {"crank_frequency_Hz", m.crank_frequency},
               {"sun_mesh_frequency_Hz", m.sun_mesh_frequency},
               {"arc_mesh_frequency_Hz", m.arc_mesh_frequency},
               {"mean_sun_force_N", m.mean_sun_force},
               {"mean_arc_force_N", m.mean_arc_force},
               {"crank_turns", m.crank_turns},
               {"total_cycles", m.total_cycles},
               {"steady", m.steady},
               {"steady_difference", json_number(m.steady_difference)},
               {"torque_balance_relative", json_number(m.torque_balance_relative)},
               {"largest_multiplier", json_number(m.largest_multiplier)},
               {"energy_relative", json_number(m.energy_relative)},
               {"error_peak_to_peak_rad", to_json(m.error_peak_to_peak)},
               {"error_mean_rad", m.error_mean},
               {"static_error_mean_rad", m.static_error_mean},
               {"static_error_peak_to_peak_rad", m.static_error_peak_to_peak},
               {"sun_planet", meshes_json(m.sun_planet)},
               {"arc_pins", meshes_json(m.arc_pins)}};
  json["results"] = to_json(m.results);
  json["arc_bearings"] = Json::array();
  for (const auto& b : m.arc_bearings)
    json["arc_bearings"].push_back(
        {{"crank", b.crank}, {"arc_gear", b.arc_gear}, {"largest_N", to_json(b.largest)}, {"mean_N", b.mean}});
  return json;
}

/// The tables, each in a file of its own.
template <class Motion, class Visit>
void for_each_motion_table(Motion& m, Visit visit) {
  visit("output_error.csv", m.output_error);
  visit("output_error_static.csv", m.static_error);
  visit("spectrum.csv", m.spectrum);
  visit("forces.csv", m.forces);
}

TwoKVMotion motion_of(const dynamics::TwoKVStage& stage, const dynamics::TwoKVResponse& r) {
  TwoKVMotion m;
  m.crank_frequency = r.crank_frequency;
  m.sun_mesh_frequency = r.sun_mesh_frequency;
  m.arc_mesh_frequency = r.arc_mesh_frequency;
  m.mean_sun_force = r.mean_sun_force;
  m.mean_arc_force = r.mean_arc_force;
  m.crank_turns = r.crank_turns;
  m.total_cycles = r.total_cycles;
  m.steady = r.steady;
  m.motions = r.motions;
  m.steady_difference = r.steady_difference;
  m.torque_balance_relative = r.torque_balance_relative;
  m.largest_multiplier = r.largest_multiplier;
  m.energy_relative = r.energy.relative;
  m.error_peak_to_peak = r.dynamic.peak_to_peak;
  m.error_mean = r.dynamic.mean;
  m.static_error_mean = r.quasi_static.mean;
  m.static_error_peak_to_peak = r.quasi_static.peak_to_peak.value;
  m.sun_planet = r.sun_planet;
  m.arc_pins = r.arc_pins;
  m.arc_bearings = r.arc_bearings;
  m.shafts = r.shafts;

  const auto& series = r.series;
  m.output_error.columns = {"crank_turn", "time_s", "error_rad"};
  m.forces.columns = {"crank_turn"};
  const auto toothed = static_cast<std::size_t>(stage.cranks) + static_cast<std::size_t>(stage.arc_gears);
  for (std::size_t i = 0; i < std::min(toothed, series.meshes.size()); ++i)
    m.forces.columns.push_back(series.meshes[i]);
  for (Eigen::Index i = 0; i < series.time.size(); ++i) {
    const double turn = (series.time[i] - series.time[0]) * r.crank_frequency;
    m.output_error.rows.push_back({turn, series.time[i], r.dynamic.series[i]});
    auto& row = m.forces.rows.emplace_back(1, turn);
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(toothed); ++k)
      row.push_back(series.force(k, i) / (k < stage.cranks ? r.mean_sun_force : r.mean_arc_force));
  }
  m.static_error.columns = {"crank_turn", "error_rad"};
  for (Eigen::Index i = 0; i < r.quasi_static_time.size(); ++i)
    m.static_error.rows.push_back({r.quasi_static_time[i] * r.crank_frequency, r.quasi_static.series[i]});
  m.spectrum.columns = {"frequency_Hz", "crank_order", "amplitude_rad"};
  for (Eigen::Index i = 0; i < r.error_spectrum.order.size() && r.error_spectrum.order[i] <= highest_crank_order; ++i)
    m.spectrum.rows.push_back(
        {r.error_spectrum.order[i] * r.crank_frequency, r.error_spectrum.order[i], r.error_spectrum.amplitude[i]});
  return m;
}

/// The factors of every mesh by itself.
constexpr std::pair<const char*, Figure dynamics::BranchResult::*> mesh_factors[] = {
    {"dynamic_factor", &dynamics::BranchResult::dynamic_factor}, {"peak_factor", &dynamics::BranchResult::peak_factor}};

std::string factor_key(const char* mesh, std::size_t n, const char* factor) {
  return fmt::format("{}{}_{}", mesh, n + 1, factor);
}

}  // namespace

bool TwoKVMotion::output_moves() const {
  return dynamics::output_moves(error_peak_to_peak.value, static_error_peak_to_peak, error_mean);
}

dynamics::Evaluation evaluation_of(const TwoKVModels& models, const dynamics::TwoKVResponse& response) {
  dynamics::Evaluation evaluation{.figures = dynamics::static_figures(models.at_nominal, models.arc_clearance),
                                  .outcome = static_cast<const dynamics::SteadyOutcome&>(response)};
  evaluation.figures.add(dynamics::figures(models.moving, response));
  const auto add = [&](const char* mesh, const std::vector<dynamics::BranchResult>& list) {
    for (std::size_t n = 0; n < list.size(); ++n)
      for (const auto& [name, factor] : mesh_factors)
        evaluation.figures.set(factor_key(mesh, n, name), list[n].*factor);
  };
  add("sun_planet", response.sun_planet);
  add("arc_pins", response.arc_pins);
  dynamics::add_each_shaft(evaluation.figures, response.shafts);
  return evaluation;
}

TwoKVMotion simulate_two_k_v(const Scene& scene, const TwoKVTables& tables,
                             const dynamics::SimulationOptions& options) {
  const auto models = two_k_v_models(scene, tables);
  const auto response = dynamics::simulate(models.moving, options);
  auto changed_options = options;
  changed_options.keep_series = false;
  changed_options.estimate_error = false;
  auto motion = motion_of(models.moving, response);
  // Every evaluation shoots for the periodic motion as the nominal one does.
  motion.results =
      with_table_errors(evaluation_of(models, response), {&tables.sun, &tables.arc},
                        [&](const std::vector<const MeshResult*>& changed) {
                          const auto other = two_k_v_models(scene, {*changed.front(), *changed.back()});
                          return evaluation_of(other, dynamics::simulate(other.moving, changed_options));
                        },
                        {.simulation = {}, .seeks_steady_state = !options.mesh_cycles, .nominal_alike = true});
  motion.error_peak_to_peak.error = motion.results.figure("output_error_peak_to_peak_rad").error;
  for (const auto& [mesh, list] : {std::pair{"sun_planet", &motion.sun_planet}, {"arc_pins", &motion.arc_pins}})
    for (std::size_t n = 0; n < list->size(); ++n)
      for (const auto& [name, factor] : mesh_factors)
        ((*list)[n].*factor).error = motion.results.figure(factor_key(mesh, n, name)).error;
  dynamics::set_errors(motion.shafts, motion.results);
  for_each_motion_table(motion, [](const char*, Csv& table) { table.round(); });
  motion.time_series = time_series_table(response.series, response.window_cycles).text();
  return motion;
}

void save(const TwoKVMotion& motion, const std::string& id, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::vector<std::pair<std::string, std::string>> header = {{"annulus_version", version()}, {"inputs_id", id}};
  for_each_motion_table(motion, [&](const char* name, Csv table) {
    table.header = header;
    table.write(folder / name);
  });
  std::string lines;
  for (const auto& [key, value] : header) lines += fmt::format("# {}: {}\n", key, value);
  write_file(folder / "time_series.csv", lines + motion.time_series);
  write_file(folder / "figures.json", text_of(motion_json(motion, id)));
}

}  // namespace annulus::app
