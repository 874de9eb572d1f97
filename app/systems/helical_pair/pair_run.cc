#include "app/systems/helical_pair/pair_run.h"

#include <fmt/format.h>

#include <cmath>

#include "app/model/time_series.h"
#include "app/results/cached_value.h"
#include "app/results/content_id.h"
#include "app/run/pipeline.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_lumped_model.h"
#include "app/systems/helical_pair/pair_members.h"
#include "app/systems/helical_pair/pair_space.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/units.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

/// Displacements as they are, and beside them the transmission error as the figures measure it.
Csv series_table(const dynamics::HelicalPair& pair, const dynamics::PairResponse& response) {
  const auto& s = response.series;
  Csv csv;
  csv.columns.emplace_back("time_s");
  Eigen::Index pinion = -1, wheel = -1;
  for (std::size_t i = 0; i < s.dofs.size(); ++i) {
    csv.columns.push_back(s.dofs[i] + "_m");
    if (s.dofs[i] == "pinion_u") pinion = static_cast<Eigen::Index>(i);
    if (s.dofs[i] == "wheel_u") wheel = static_cast<Eigen::Index>(i);
  }
  csv.columns.insert(csv.columns.end(), {"mesh_force_N", "transmission_error_m"});
  // Half the backlash is no error of a loaded mesh (PairMotions).
  const double side = pair.pinion_torque > 0 ? 1 : pair.pinion_torque < 0 ? -1 : 0;
  const double touching = side * pair.half_backlash.value_or(0) / std::cos(pair.base_helix_angle);
  const auto samples = written_samples(s, response.window_cycles, csv);
  for (Eigen::Index i = 0; i < samples; ++i) {
    auto& row = csv.rows.emplace_back(1, s.time[i]);
    row.insert(row.end(), s.displacement.col(i).begin(), s.displacement.col(i).end());
    row.push_back(s.force(0, i));
    row.push_back(s.displacement(pinion, i) + s.displacement(wheel, i) - touching);
  }
  return csv;
}

Csv spectrum_table(const dynamics::PairResponse& response) {
  constexpr double highest = 8;  // multiples of the mesh frequency
  const auto spectrum =
      dynamics::spectrum(Eigen::VectorXd(response.series.force.row(0).transpose()), response.window_cycles);
  Csv csv{.header = {}, .columns = {"frequency_Hz", "mesh_order", "mesh_force_N"}, .rows = {}};
  for (Eigen::Index i = 0; i < spectrum.order.size() && spectrum.order[i] <= highest; ++i)
    csv.rows.push_back({spectrum.order[i] * response.mesh_frequency, spectrum.order[i], spectrum.amplitude[i]});
  return csv;
}

Csv modes_table_of(const dynamics::Modes& modes) {
  Csv csv{.header = {}, .columns = {"index", "frequency_Hz"}, .rows = {}};
  for (const auto& dof : modes.dofs) csv.columns.push_back(dof);
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    auto& row = csv.rows.emplace_back(std::vector{static_cast<double>(i + 1), modes.modes[i].frequency});
    row.insert(row.end(), modes.modes[i].shape.begin(), modes.modes[i].shape.end());
  }
  return csv;
}

void write_table(Csv csv, const std::string& id, const std::filesystem::path& file) {
  csv.header = {{"annulus_version", version()}, {"inputs_id", id}};
  csv.write(file);
}

/// As each of many responses is found.
dynamics::SimulationOptions without_confirmation(const Scene& scene) {
  auto simulation = pair_simulation(scene);
  simulation.confirmation = dynamics::Confirmation::where_needed;
  simulation.keep_series = false;
  simulation.other_motions.starts = 0;  // causes are compared on motions that belong together
  return simulation;
}

ShareRow share_row(const LumpedPair& nominal, double torque) {
  ShareRow row{.pinion_torque = torque};
  try {
    // The scene at another torque: a tabulated stiffness belongs to its load.
    auto scene = nominal.scene;
    helical_pair(scene).stage.pinion_torque = torque;
    auto geometry = nominal.geometry;
    geometry.transverse_force = torque / geometry.pinion().base_radius();
    const bool closed_form = helical_pair(scene).pinion_wheel.stiffness == StiffnessShape::closed_form;
    const auto pair = lumped_pair(scene, geometry,
                                  closed_form ? pair_stiffness(scene, geometry, nominal.mesh.model, {}) : nominal.mesh,
                                  nominal.mesh_error)
                          .pair;
    const auto simulation = without_confirmation(scene);
    row.shares = dynamics::transmission_error_shares(pair, simulation);
    const auto whole = dynamics::evaluate_pair(pair, simulation);
    row.largest_dynamic = whole.dynamic.transmission_error.largest.value;
    row.largest_static = whole.quasi_static.transmission_error.largest.value;
  } catch (const Error& error) {
    row.failure = error.what();
    log::warn(fmt::format("transmission error at {} N m: {}", to_text(torque), row.failure));
  }
  return row;
}

SpeedRow speed_row(const LumpedPair& nominal, double speed) {
  SpeedRow row{.pinion_speed = speed};
  auto scene = nominal.scene;
  helical_pair(scene).stage.pinion_speed = speed;
  const auto simulation = without_confirmation(scene);
  auto pair = nominal.pair;
  pair.pinion_speed = speed;
  const auto motion = [&](const dynamics::HelicalPair& p) {
    const auto r = dynamics::evaluate_pair(p, simulation);
    return SpeedRow::Motion{r.acceleration.tooth.value, r.force_max.value - r.force_min.value,
                            r.dynamic.transmission_error.peak_to_peak.value};
  };
  try {
    row.all = motion(pair);
    row.errors_alone = motion(dynamics::with_errors_alone(pair));
    row.stiffness_alone = motion(dynamics::with_stiffness_alone(pair));
  } catch (const Error& error) {
    row.failure = error.what();
    log::warn(fmt::format("causes at {} r/min: {}", to_text(speed / units::rpm, 6), row.failure));
  }
  return row;
}

void save_speeds(const std::vector<SpeedRow>& rows, const std::filesystem::path& folder) {
  Csv csv{.header = {{"annulus_version", version()}}, .columns = {"pinion_speed_rpm"}, .rows = {}};
  for (const std::string cause : {"all", "errors_alone", "stiffness_alone"}) {
    for (const auto* what : {"_acceleration_m_per_s2", "_force_peak_to_peak_N", "_transmission_error_m"})
      csv.columns.push_back(cause + what);
  }
  for (const auto& row : rows) {
    if (!row.failure.empty()) continue;
    auto& cells = csv.rows.emplace_back(1, row.pinion_speed / units::rpm);
    for (const auto* m : {&row.all, &row.errors_alone, &row.stiffness_alone})
      cells.insert(cells.end(), {m->acceleration, m->peak_to_peak_force, m->peak_to_peak_te});
  }
  csv.write(folder / "causes_over_speed.csv");
}

void save_shares(const std::vector<ShareRow>& rows, const std::filesystem::path& folder) {
  Csv csv{.header = {{"annulus_version", version()}},
          .columns = {"pinion_torque_Nm", "load_deflection_m", "peak_to_peak_static_m", "errors_alone_static_m",
                      "stiffness_alone_static_m", "peak_to_peak_dynamic_m", "errors_alone_dynamic_m",
                      "stiffness_alone_dynamic_m", "largest_static_m", "largest_dynamic_m"},
          .rows = {}};
  for (const auto& row : rows) {
    if (!row.failure.empty()) continue;
    const auto& s = row.shares;
    csv.rows.push_back({row.pinion_torque, s.load_deflection, s.all.quasi_static, s.errors_alone.quasi_static,
                        s.stiffness_alone.quasi_static, s.all.dynamic, s.errors_alone.dynamic,
                        s.stiffness_alone.dynamic, row.largest_static, row.largest_dynamic});
  }
  csv.write(folder / "transmission_error_shares.csv");
}

PairResponseResult response_of(const LumpedPair& lumped, const MeshResult& mesh,
                               const dynamics::SimulationOptions& simulation, const RunOptions& options) {
  const auto& scene = lumped.scene;
  const auto& pair = lumped.pair;
  PairResponseResult response;
  auto& f = response.figures = dynamics::evaluate_pair(pair, simulation);
  response.modes = dynamics::modes(pair);
  response.series = series_table(pair, f);
  response.spectrum = spectrum_table(f);
  response.space = space_results(dynamics::space_motion(pair, f.series), f.window_cycles);
  if (pair.space)
    add_face_loads(response.space, moving_pair_face(scene, lumped.geometry, pair, mesh, options), options.threads);
  f.series = {};
  response.results = propagated_pair_errors(lumped, simulation, f);
  const auto& asked = helical_pair(scene).transmission_error;
  if (!asked) return response;
  const auto fill = [&](auto& rows, const std::vector<double>& values, auto row_of) {
    rows.resize(values.size());
    for_each_task(values.size(), options.threads, [&](std::size_t i) { rows[i] = row_of(lumped, values[i]); });
  };
  fill(response.shares, asked->pinion_torques, share_row);
  fill(response.speeds, asked->pinion_speeds, speed_row);
  return response;
}

}  // namespace

std::unique_ptr<PairRunResponse> pair_response(const Scene& scene, const MeshResult& mesh, const RunOptions& options) {
  const auto folder = options.out / "dynamics";
  std::filesystem::create_directories(folder);
  const auto lumped = lumped_pair(scene, make_pair_geometry(scene), mesh, pair_errors(scene).amplitude);
  auto simulation = pair_simulation(scene);
  simulation.other_motions.threads = options.threads;
  const auto& asked = helical_pair(scene).transmission_error;
  const auto id =
      identity_of(lumped.id(simulation), mesh.model.id(), asked ? asked->pinion_torques : std::vector<double>(),
                  asked ? asked->pinion_speeds : std::vector<double>());
  auto [response, reused] = cached_value(options.store.get(), "pair_responses", id,
                                         [&] { return response_of(lumped, mesh, simulation, options); });
  note_reuse(options, "dynamics of the pair", source_of(reused));
  write_table(response.series, id, folder / "time_series.csv");
  write_table(response.spectrum, id, folder / "spectrum.csv");
  write_table(modes_table_of(response.modes), id, folder / "modes.csv");
  if (!response.space.bearings.empty()) write_table(response.space.table, id, folder / "bearings_in_space.csv");
  if (!response.space.faces.empty()) write_table(face_loads_table(response.space), id, folder / "face_loads.csv");
  if (asked) save_shares(response.shares, folder);
  if (!response.speeds.empty()) save_speeds(response.speeds, folder);
  const auto& f = response.figures;
  log::info("dynamics: " + (reused ? "unchanged, reused"
                                   : fmt::format("{} mesh cycles integrated, {}", f.total_cycles,
                                                 f.steady ? "periodic steady state" : "no periodic steady state")));
  auto result = std::make_unique<PairRunResponse>();
  result->pair = lumped.pair;
  result->figures = response.results;
  result->motions = f.motions;
  result->shafts = f.shafts;
  result->reused = reused;
  result->response = std::move(response);
  return result;
}

PairRunResult::PairRunResult(const SystemRun& of)
    : RunView(of),
      geometry(make_pair_geometry(of.scene)),
      mesh(of.tables.front()),
      stiffnesses(mean_stiffnesses(of.scene, geometry, mesh)),
      errors(pair_errors(of.scene)) {
  if (of.responses.empty()) return;
  const auto& found = static_cast<const PairRunResponse&>(*of.responses.front());
  pair = &found.pair;
  response = &found.response;
  shares = found.response.shares;
  speeds = found.response.speeds;
}

PairRunResult run_pair(const Scene& scene, const RunOptions& options) {
  return PairRunResult(*run_system(scene, options));
}

}  // namespace annulus::app
