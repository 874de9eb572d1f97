#include "app/systems/helical_pair/pair_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/cost_actual.h"
#include "app/model/mesh_figures.h"
#include "app/results/content_id.h"
#include "app/run/pipeline.h"
#include "app/systems/helical_pair/pair_table_errors.h"
#include "core/errors.h"
#include "core/files.h"
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
  for (Eigen::Index i = 0; i < s.time.size(); ++i) {
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

PairResponseResult respond(const PairRunResult& result, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto& pair = *result.pair;
  const auto simulation = pair_simulation(result.scene);
  PairResponseResult response{.figures = dynamics::evaluate_pair(pair, simulation),
                              .modes = dynamics::modes(pair),
                              .series = {},
                              .spectrum = {}};
  response.series = series_table(pair, response.figures);
  response.spectrum = spectrum_table(response.figures);
  response.figures.series = {};
  response.results = carried_pair_errors(result, simulation, response.figures);
  const auto id = pair_id(pair, simulation, result.mesh.table ? &*result.mesh.table : nullptr);
  write_table(response.series, id, folder / "time_series.csv");
  write_table(response.spectrum, id, folder / "spectrum.csv");
  write_table(modes_table_of(response.modes), id, folder / "modes.csv");
  const auto& f = response.figures;
  log::info(fmt::format("dynamics: {} mesh cycles integrated, {}", f.total_cycles,
                        f.steady ? "periodic steady state" : "no periodic steady state"));
  return response;
}

ShareRow share_row(const PairRunResult& result, double torque) {
  ShareRow row{.pinion_torque = torque};
  try {
    // The scene at another torque: a tabulated stiffness belongs to its load.
    auto scene = result.scene;
    scene.stage.pinion_torque = torque;
    auto geometry = result.geometry;
    geometry.transverse_force = torque / geometry.pinion().base_radius();
    PairMesh mesh = result.mesh;
    if (scene.pinion_wheel.stiffness == StiffnessShape::closed_form)
      mesh.table = closed_form_pair_table(scene, geometry, geometry.transverse_force);
    auto pair = make_pair(scene, geometry, pair_excitation(scene, geometry, mesh), result.errors.amplitude);
    auto simulation = pair_simulation(scene);
    simulation.confirm = false;
    simulation.keep_series = false;
    row.shares = dynamics::transmission_error_shares(pair, simulation);
    const auto whole = dynamics::evaluate_pair(pair, simulation);
    row.largest_dynamic = whole.dynamic.transmission_error.largest.value;
    row.largest_static = whole.quasi_static.transmission_error.largest.value;
  } catch (const Error& error) {
    row.failure = error.what();
  }
  return row;
}

SpeedRow speed_row(const PairRunResult& result, double speed) {
  SpeedRow row{.pinion_speed = speed};
  auto scene = result.scene;
  scene.stage.pinion_speed = speed;
  auto simulation = pair_simulation(scene);
  simulation.confirm = false;
  simulation.keep_series = false;
  auto pair = *result.pair;
  pair.pinion_speed = speed;
  auto constant = pair, flawless = pair;
  constant.mesh = dynamics::ConstantStiffness{dynamics::mean_stiffness(pair.mesh)};
  flawless.mesh_error = flawless.pinion.error = flawless.wheel.error = {};
  const auto motion = [&](const dynamics::HelicalPair& p) {
    const auto r = dynamics::evaluate_pair(p, simulation);
    return SpeedRow::Motion{r.acceleration.tooth.value, r.force_max.value - r.force_min.value,
                            r.dynamic.transmission_error.peak_to_peak.value};
  };
  try {
    row.all = motion(pair);
    row.errors_alone = motion(constant);
    row.stiffness_alone = motion(flawless);
  } catch (const Error& error) {
    row.failure = error.what();
  }
  return row;
}

void save_speeds(const std::vector<SpeedRow>& rows, const std::filesystem::path& folder) {
  Csv csv{.header = {{"annulus_version", version()}}, .columns = {"pinion_speed_rpm"}, .rows = {}};
  for (const std::string cause : {"all", "errors_alone", "stiffness_alone"}) {
    for (const auto* what : {"_acceleration_m_per_s2", "_force_range_N", "_transmission_error_m"})
      csv.columns.push_back(cause + what);
  }
  for (const auto& row : rows) {
    if (!row.failure.empty()) continue;
    auto& cells = csv.rows.emplace_back(1, row.pinion_speed / units::rpm);
    for (const auto* m : {&row.all, &row.errors_alone, &row.stiffness_alone})
      cells.insert(cells.end(), {m->acceleration, m->force_range, m->te_range});
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

}  // namespace

PairRunResult::PairRunResult(const Scene& of) : geometry(make_pair_geometry(of)) { scene = of; }

void PairRunResult::solve_meshes(const RunOptions& options) {
  {
    const auto& model = plan.meshes.front();
    mesh = pair_mesh(scene, geometry, pair_stiffness(model, options));
    not_solved.model = model;
    stiffnesses = mean_stiffnesses(scene, geometry, mesh);
    if (mesh.table && !mesh.computed) {
      auto table = *mesh.table;
      table.provenance = {{"annulus_version", version()}, {"source", model.reason}};
      table.write_csv(options.out / "stiffness_pinion_wheel.csv");
    }
  }
  const auto timer = timers.measure("errors");
  errors = pair_errors(scene);
  save_pair_errors(errors, options.out / "errors");
}

void PairRunResult::respond(const RunOptions& options) {
  const auto folder = options.out / "dynamics";
  pair = make_pair(scene, geometry, pair_excitation(scene, geometry, mesh), errors.amplitude);
  {
    const auto timer = timers.measure("dynamics");
    response = app::respond(*this, folder);
  }
  if (!scene.transmission_error) return;
  const auto timer = timers.measure("shares");
  const auto& torques = scene.transmission_error->pinion_torques;
  shares.resize(torques.size());
  for_each_task(torques.size(), options.threads, [&](std::size_t i) { shares[i] = share_row(*this, torques[i]); });
  for (const auto& row : shares) {
    if (!row.failure.empty())
      log::warn(fmt::format("transmission error at {} N m: {}", to_text(row.pinion_torque), row.failure));
  }
  save_shares(shares, folder);
  const auto& wanted = scene.transmission_error->pinion_speeds;
  speeds.resize(wanted.size());
  for_each_task(wanted.size(), options.threads, [&](std::size_t i) { speeds[i] = speed_row(*this, wanted[i]); });
  for (const auto& row : speeds) {
    if (!row.failure.empty())
      log::warn(fmt::format("causes at {} r/min: {}", to_text(row.pinion_speed / units::rpm, 6), row.failure));
  }
  if (!speeds.empty()) save_speeds(speeds, folder);
}

std::vector<const MeshResult*> PairRunResult::meshes() const {
  if (!mesh.computed) return {};
  return {&*mesh.computed};
}

std::vector<const MeshResult*> PairRunResult::model_tables() const {
  return {mesh.computed ? &*mesh.computed : &not_solved};
}

std::vector<VariantFigures> PairRunResult::variants() const {
  FigureSet set;
  for (const auto& s : stiffnesses)
    if (s.taken) set.set("mean_stiffness_N_per_m", {s.value, std::abs(s.value) * s.error_relative});
  if (mesh.computed) set.add(mesh_figures(*mesh.computed));
  if (response) set.add(response->results);
  return {{"", std::move(set)}};
}

std::optional<CostRun> PairRunResult::actual(const CostStep& step) const {
  if (step.kind == CostKind::mesh) return mesh.computed ? actual_mesh(step.size, *mesh.computed) : std::nullopt;
  if (!response) return std::nullopt;
  return actual_time(step.size, timers.seconds("dynamics") + timers.seconds("shares"));
}

PairRunResult run_pair(const Scene& scene, const RunOptions& options) {
  PairRunResult result(scene);
  run_system(result, options);
  return result;
}

const std::vector<FigureSpec>& pair_run_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs = {{.key = "mean_stiffness_N_per_m",
                                      .title = "Mean stiffness along the normal, as applied",
                                      .unit = "N/µm",
                                      .scale = 1e-6,
                                      .definition =
                                          "mean mesh stiffness along the normal of the flanks that the lumped "
                                          "model has",
                                      .effort = FigureEffort::tables,
                                      .guarantee = Guarantee::always,
                                      .quantity = "mean_stiffness",
                                      .compared = true}};
    const auto mesh = mesh_figure_specs(pinion_wheel, "mesh", "pinion_wheel_stiffness", {"pinion", "wheel"});
    specs.insert(specs.end(), mesh.begin(), mesh.end());
    const auto& model = dynamics::pair_figures();
    specs.insert(specs.end(), model.begin(), model.end());
    return specs;
  }();
  return list;
}

}  // namespace annulus::app
