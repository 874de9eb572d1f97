#include "app/systems/planetary/stage_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/time_series.h"
#include "app/results/content_id.h"
#include "app/systems/planetary/alternative_stages.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/shared/face_loads.h"
#include "core/errors.h"
#include "core/file_guard.h"
#include "core/files.h"
#include "dynamics/figures/spectrum.h"
#include "dynamics/systems/planetary/gauge_strain.h"

namespace annulus::app {

namespace {

constexpr int waveform_cycles = 6;
constexpr double highest_order = 8;  // multiples of the mesh frequency kept in the spectrum

std::vector<std::string> columns(const std::string& first, const std::vector<std::string>& branches,
                                 const std::vector<std::string>& suffixes) {
  std::vector<std::string> names = {first};
  for (const auto& branch : branches) {
    for (const auto& suffix : suffixes) names.push_back(branch + suffix);
  }
  return names;
}

/// Branch factor N F / sum F, the sum over the branches of the same kind (sun meshes first, then ring meshes).
Eigen::MatrixXd sharing(const Eigen::MatrixXd& force, Eigen::Index planets) {
  Eigen::MatrixXd result(2 * planets, force.cols());
  result.topRows(planets) = dynamics::load_sharing_over_time(force.topRows(planets));
  result.bottomRows(planets) = dynamics::load_sharing_over_time(force.middleRows(planets, planets));
  return result;
}

void tabulate(StageResponse& result, const dynamics::DynamicResponse& response, int planets) {
  const auto& series = response.series;
  const int cycles = response.window_cycles;
  const Eigen::Index samples = series.time.size() / cycles;
  const Eigen::Index toothed = 2 * static_cast<Eigen::Index>(planets);  // bearings with play follow
  const std::vector<std::string> meshes(series.meshes.begin(), series.meshes.begin() + toothed);
  const Eigen::MatrixXd force = series.force.topRows(toothed);
  const Eigen::MatrixXd factor = force / response.mean_mesh_force;
  const Eigen::MatrixXd momentary = sharing(force, planets);
  const Eigen::MatrixXd averaged = sharing(response.cycle_force, planets);

  result.load_sharing.columns = columns("mesh_cycle", meshes, {"_averaged", "_min", "_max"});
  result.force_factors.columns = columns("mesh_cycle", meshes, {"_smallest", "_largest", "_dynamic_factor"});
  for (int c = 0; c < cycles; ++c) {
    const auto shares = momentary.middleCols(c * samples, samples);
    const auto factors = factor.middleCols(c * samples, samples);
    auto& sharing_row = result.load_sharing.rows.emplace_back(1, c);
    auto& factor_row = result.force_factors.rows.emplace_back(1, c);
    for (Eigen::Index b = 0; b < factor.rows(); ++b) {
      sharing_row.insert(sharing_row.end(), {averaged(b, c), shares.row(b).minCoeff(), shares.row(b).maxCoeff()});
      const double largest = factors.row(b).cwiseAbs().maxCoeff(), mean = std::abs(factors.row(b).mean());
      factor_row.insert(factor_row.end(), {factors.row(b).minCoeff(), largest, mean > 0 ? largest / mean : not_known});
    }
  }

  const auto first_cycles = [&](const Eigen::MatrixXd& values) {
    Csv csv;
    csv.columns = columns("mesh_cycle", meshes, {""});
    for (Eigen::Index i = 0; i < std::min(waveform_cycles, cycles) * samples; ++i) {
      auto& row = csv.rows.emplace_back(1, static_cast<double>(i) / static_cast<double>(samples));
      row.insert(row.end(), values.col(i).begin(), values.col(i).end());
    }
    return csv;
  };
  result.waveform = first_cycles(factor);
  result.sharing_waveform = first_cycles(momentary);

  result.spectrum.columns = columns("frequency_Hz", meshes, {"_N"});
  result.spectrum.columns.insert(result.spectrum.columns.begin() + 1, "mesh_order");
  std::vector<dynamics::Spectrum> spectra;
  for (Eigen::Index b = 0; b < factor.rows(); ++b) {
    spectra.push_back(dynamics::spectrum(Eigen::VectorXd(force.row(b).transpose()), cycles));
  }
  for (Eigen::Index i = 0; i < spectra.front().order.size() && spectra.front().order[i] <= highest_order; ++i) {
    const double order = spectra.front().order[i];
    auto& row = result.spectrum.rows.emplace_back(std::vector{order * response.mesh_frequency, order});
    for (const auto& s : spectra) row.push_back(s.amplitude[i]);
  }
}

/// Empty without gauges or lines.
Csv gauge_spectrum(const dynamics::PlanetaryStage& stage, const Csv& gauges,
                   const dynamics::DynamicResponse& response) {
  const auto lines = dynamics::strain_lines(stage, gauge_curves(gauges), response);
  if (!lines) return {};
  Csv csv;
  csv.columns = {"mesh_order", "carrier_order", "frequency_Hz"};
  for (Eigen::Index g = 0; g < lines->amplitude.rows(); ++g)
    csv.columns.push_back(fmt::format("gauge_{}_um_per_m", g + 1));
  for (Eigen::Index i = 0; i < lines->order.size(); ++i) {
    const double order = lines->order[i];
    auto& row = csv.rows.emplace_back(std::vector{order, order * stage.ring_teeth, order * response.mesh_frequency});
    row.insert(row.end(), lines->amplitude.col(i).begin(), lines->amplitude.col(i).end());
  }
  return csv;
}

/// The tables, each in a file of its own.
template <class Response, class Visit>
void for_each_stage_table(Response& r, Visit visit) {
  visit("load_sharing.csv", r.load_sharing);
  visit("force_factors.csv", r.force_factors);
  visit("waveform.csv", r.waveform);
  visit("load_sharing_waveform.csv", r.sharing_waveform);
  visit("spectrum.csv", r.spectrum);
  visit("strain_gauge_spectrum.csv", r.gauge_spectrum);
  visit("bearing_forces.csv", r.motion.bearing_forces);
  visit("bearings_in_space.csv", r.motion.space.table);
  visit("sun_orbit.csv", r.motion.sun_orbit);
  visit("poincare.csv", r.motion.poincare);
  visit("mode_shapes.csv", r.modes.shapes);
  visit("campbell.csv", r.modes.campbell);
  visit("critical_speeds.csv", r.modes.critical_speeds);
}

/// The largest part of its torque that friction can bring to the sun: the lever of a tooth pair over the base radius.
double largest_share_of_friction(const dynamics::PlanetaryStage& stage) {
  if (!stage.sun_friction) return 0;
  const auto& distances = stage.sun_friction->sliding.distance;
  double farthest = 0;
  for (int piece = 0; piece < distances.pieces(); ++piece)
    farthest = std::max(farthest, std::abs(distances.coefficients(piece)[0]));
  return stage.sun_friction->coefficient * (std::tan(std::abs(stage.sun_working_angle)) + farthest / stage.sun.radius);
}

/// What repeats has to carry the torque; teeth that errors hold apart for longer than was looked at carry nothing, and
/// repeat as well.
void check_power(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response,
                 double steady_tolerance) {
  if (!response.steady || stage.sun.torsional_support != 0) return;
  double carried = 0;
  for (const auto& branch : response.sun_planet.branches) carried += branch.mean_force;
  carried /= stage.planets() * stage.mean_mesh_force();
  if (std::abs(carried - 1) <= 10 * steady_tolerance + largest_share_of_friction(stage)) return;
  throw SolverError(
      fmt::format("the teeth carry only {:.3g} of the sun's torque. The torque is too small to close the gaps from the "
                  "errors in the computed motion; raise the power or torque of [stage], or reduce [errors]",
                  carried));
}

/// The modes; what makes the elastic modes of a ring unusable is the choice of a key.
StageModes modes_of(const dynamics::PlanetaryStage& stage, const StageTables& tables) {
  try {
    auto modes = stage_modes(stage, stiffness_errors(tables.sun_mesh, tables.ring_mesh));
    for (const auto& other : alternative_stages(stage, tables.sun_mesh, tables.ring_mesh))
      add_model_change(modes, other);
    return modes;
  } catch (const SolverError& error) {
    if (!stage.ring_coupling || stage.ring_coupling->modes.empty()) throw;
    throw InputError(
        fmt::format("dynamics.rim_coupling = \"elastic\": {}; use \"static\" or \"automatic\"", error.what()));
  }
}

}  // namespace

StageResponse simulate_stage(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& options,
                             const StageTables& tables) {
  StageResponse result;
  result.modes = modes_of(stage, tables);
  auto response = dynamics::simulate(stage, options);
  check_power(stage, response, options.steady_tolerance);
  tabulate(result, response, stage.planets());
  result.motion = tabulated_motion(stage, response);
  result.gauge_spectrum = gauge_spectrum(stage, tables.ring_mesh.gauges, response);
  for_each_stage_table(result, [](const char*, Csv& table) { table.round(); });
  result.time_series = time_series_table(response.series, response.window_cycles).text();
  response.series = {};
  result.errors = propagated_errors(response, options, tables);
  set_errors(result.errors, response);
  result.figures = std::move(response);
  return result;
}

void save(const StageResponse& response, const std::string& id, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::vector<std::pair<std::string, std::string>> header = {{"annulus_version", version()}, {"inputs_id", id}};
  const auto write = [&](const char* name, Csv table) {
    if (table.columns.empty()) {  // of another kind of stage
      remove_file(folder / name);
      return;
    }
    table.header = header;
    table.write(folder / name);
  };
  for_each_stage_table(response, write);
  write("face_loads.csv", face_loads_table(response.motion.space));
  std::string lines;
  for (const auto& [key, value] : header) lines += fmt::format("# {}: {}\n", key, value);
  write_file(folder / "modes.csv", lines + modes_csv(response.modes));
  write_file(folder / "time_series.csv", lines + response.time_series);
  write_file(folder / "figures.json", text_of(response_json(response, id)));
}

}  // namespace annulus::app
