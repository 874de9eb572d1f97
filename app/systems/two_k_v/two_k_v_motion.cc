#include "app/systems/two_k_v/two_k_v_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/results/content_id.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

namespace {

constexpr const char *figures_file = "figures.json", *series_file = "time_series.csv";
constexpr double highest_crank_order = 200;  // several multiples of both mesh orders

std::optional<double> optional_number(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<double>();
}

Json meshes_json(const std::vector<dynamics::BranchResult>& meshes) {
  auto json = Json::array();
  for (const auto& m : meshes)
    json.push_back({{"dynamic_factor_max", m.dynamic_factor_max.value},
                    {"dynamic_factor_max_error", m.dynamic_factor_max.error},
                    {"dynamic_factor_min", m.dynamic_factor_min},
                    {"mean_force_N", m.mean_force},
                    {"contact_loss", m.contact_loss}});
  return json;
}

std::vector<dynamics::BranchResult> meshes_of(const Json& json) {
  std::vector<dynamics::BranchResult> meshes;
  for (const auto& m : json)
    meshes.push_back({{m.at("dynamic_factor_max"), number_of(m.at("dynamic_factor_max_error"))},
                      m.at("dynamic_factor_min"),
                      m.at("mean_force_N"),
                      m.at("contact_loss")});
  return meshes;
}

std::string motion_json(const TwoKVMotion& m, const std::string& id) {
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
               {"error_peak_to_peak_rad", m.error_peak_to_peak.value},
               {"error_peak_to_peak_error_rad", m.error_peak_to_peak.error},
               {"error_mean_rad", m.error_mean},
               {"static_error_mean_rad", m.static_error_mean},
               {"static_error_peak_to_peak_rad", m.static_error_peak_to_peak},
               {"sun_planet", meshes_json(m.sun_planet)},
               {"arc_pins", meshes_json(m.arc_pins)}};
  json["results"] = to_json(m.results);
  json["arc_bearings"] = Json::array();
  for (const auto& b : m.arc_bearings)
    json["arc_bearings"].push_back(
        {{"crank", b.crank}, {"arc_gear", b.arc_gear}, {"largest_N", b.largest}, {"mean_N", b.mean}});
  return json.dump(1) + "\n";
}

TwoKVMotion parse_motion(const Json& json) {
  TwoKVMotion m;
  m.crank_frequency = json.at("crank_frequency_Hz");
  m.sun_mesh_frequency = json.at("sun_mesh_frequency_Hz");
  m.arc_mesh_frequency = json.at("arc_mesh_frequency_Hz");
  m.mean_sun_force = json.at("mean_sun_force_N");
  m.mean_arc_force = json.at("mean_arc_force_N");
  m.crank_turns = json.at("crank_turns");
  m.total_cycles = json.at("total_cycles");
  m.steady = json.at("steady");
  m.steady_difference = optional_number(json.at("steady_difference"));
  m.torque_balance_relative = optional_number(json.at("torque_balance_relative"));
  m.largest_multiplier = optional_number(json.at("largest_multiplier"));
  m.energy_relative = optional_number(json.at("energy_relative")).value_or(std::nan(""));
  m.error_peak_to_peak = {json.at("error_peak_to_peak_rad"), json.at("error_peak_to_peak_error_rad")};
  m.error_mean = json.at("error_mean_rad");
  m.static_error_mean = json.at("static_error_mean_rad");
  m.static_error_peak_to_peak = json.at("static_error_peak_to_peak_rad");
  m.sun_planet = meshes_of(json.at("sun_planet"));
  m.arc_pins = meshes_of(json.at("arc_pins"));
  m.results = figure_set_of(json.at("results"));
  for (const auto& b : json.at("arc_bearings"))
    m.arc_bearings.push_back({b.at("crank"), b.at("arc_gear"), b.at("largest_N"), b.at("mean_N")});
  return m;
}

std::vector<std::pair<const char*, Csv*>> motion_tables(TwoKVMotion& m) {
  return {{"output_error.csv", &m.output_error},
          {"output_error_static.csv", &m.static_error},
          {"spectrum.csv", &m.spectrum},
          {"forces.csv", &m.forces}};
}

Csv motion_series(const dynamics::TimeSeries& series) {
  Csv csv;
  csv.columns.emplace_back("time_s");
  for (const auto& name : series.dofs) csv.columns.push_back(name + "_m");
  for (const auto& name : series.meshes) csv.columns.push_back(name + "_force_N");
  for (Eigen::Index i = 0; i < series.time.size(); ++i) {
    auto& row = csv.rows.emplace_back(1, series.time[i]);
    row.insert(row.end(), series.displacement.col(i).begin(), series.displacement.col(i).end());
    row.insert(row.end(), series.force.col(i).begin(), series.force.col(i).end());
  }
  csv.round();
  return csv;
}

}  // namespace

bool TwoKVMotion::output_moves() const {
  return dynamics::output_moves(error_peak_to_peak.value, static_error_peak_to_peak, error_mean);
}

double TwoKVMotion::dynamic_factor(bool arc) const {
  return dynamics::largest_dynamic_factor(arc ? arc_pins : sun_planet).value;
}

double TwoKVMotion::contact_loss(bool arc) const { return dynamics::largest_contact_loss(arc ? arc_pins : sun_planet); }

double TwoKVMotion::largest_bearing_force() const {
  double largest = 0;
  for (const auto& bearing : arc_bearings) largest = std::max(largest, bearing.largest);
  return largest;
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

namespace {

std::string factor_key(const char* mesh, std::size_t n) { return fmt::format("{}{}_dynamic_factor", mesh, n + 1); }

}  // namespace

dynamics::Evaluation evaluation_of(const TwoKVModels& models, const dynamics::TwoKVResponse& response) {
  dynamics::Evaluation evaluation{.figures = dynamics::static_figures(models.at_nominal, models.arc_clearance),
                                  .outcome = response};
  evaluation.figures.add(dynamics::figures(models.moving, response));
  const auto add = [&](const char* mesh, const std::vector<dynamics::BranchResult>& list) {
    for (std::size_t n = 0; n < list.size(); ++n)
      evaluation.figures.set(factor_key(mesh, n), list[n].dynamic_factor_max);
  };
  add("sun_planet", response.sun_planet);
  add("arc_pins", response.arc_pins);
  return evaluation;
}

TwoKVMotion simulate_two_k_v(const TwoKVModels& models, const dynamics::SimulationOptions& options,
                             const dynamics::TabulatedModel& tables, const std::string& id,
                             const std::filesystem::path& folder) {
  const auto response = dynamics::simulate(models.moving, options);
  auto motion = motion_of(models.moving, response);
  motion.results = propagate_errors(evaluation_of(models, response), tables);
  motion.error_peak_to_peak.error = motion.results.figure("output_error_peak_to_peak_rad").error;
  for (std::size_t n = 0; n < motion.sun_planet.size(); ++n)
    motion.sun_planet[n].dynamic_factor_max.error = motion.results.figure(factor_key("sun_planet", n)).error;
  for (std::size_t n = 0; n < motion.arc_pins.size(); ++n)
    motion.arc_pins[n].dynamic_factor_max.error = motion.results.figure(factor_key("arc_pins", n)).error;
  std::filesystem::create_directories(folder);
  const std::vector<std::pair<std::string, std::string>> header = {{"annulus_version", version()}, {"inputs_id", id}};
  for (const auto& [name, table] : motion_tables(motion)) {
    table->header = header;
    table->round();
    table->write(folder / name);
  }
  Csv series = motion_series(response.series);
  series.header = header;
  series.write(folder / series_file);
  write_file(folder / figures_file, motion_json(motion, id));
  return motion;
}

std::vector<std::string> two_k_v_files() {
  std::vector<std::string> names = {figures_file, series_file};
  TwoKVMotion any;
  for (const auto& [name, table] : motion_tables(any)) names.emplace_back(name);
  return names;
}

TwoKVMotion load_two_k_v(const std::filesystem::path& folder) {
  auto motion = parse_motion(Json::parse(read_file(folder / figures_file)));
  for (const auto& [name, table] : motion_tables(motion)) *table = Csv::read(folder / name);
  motion.reused = true;
  return motion;
}

}  // namespace annulus::app
