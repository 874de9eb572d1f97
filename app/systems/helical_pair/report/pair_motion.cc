#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double shown_pair_cycles = 6;

/// The first rows of a column, each value times `scale`.
std::vector<double> scaled_column(const Csv& csv, const std::string& name, std::size_t rows, double scale) {
  auto values = column_values(csv, name, 1e99, scale);
  values.resize(std::min(rows, values.size()));
  return values;
}

}  // namespace

Section pair_figures_section(const PairRunResult& result) {
  Section section{"figures", "Key figures"};
  if (!result.response) return section;
  const auto& f = result.response->figures;
  PageTable table{.head = {"", "value"}, .style = PageTable::Style::numbers};
  const auto row = [&](const std::string& name, const Figure& figure, double scale, const char* unit) {
    table.rows.push_back({name, measured(scale * figure.value, scale * figure.error) + " " + unit});
  };
  const auto plain = [&](const std::string& name, double value, const std::string& unit) {
    table.rows.push_back({name, to_text(value, 5) + " " + unit});
  };
  table.rows.push_back({"Mesh force along the normal of the flanks"});
  plain("static", f.static_force / 1e3, "kN");
  const auto force = dynamics::loaded_force(f);
  row("largest, in the direction of the load", force.largest, 1e-3, "kN");
  row("smallest", force.smallest, 1e-3, "kN");
  if (std::isfinite(f.dynamic_factor.value)) row("dynamic factor, largest / static", f.dynamic_factor, 1, "");
  plain("time without contact", 100 * f.contact_loss, "%");
  table.rows.push_back({"Largest accelerations"});
  row("of the teeth in mesh, with the turning of the gears", f.acceleration.tooth, 1, "m/s²");
  row("of the base circles, turning alone", f.acceleration.rotation, 1, "m/s²");
  row("of the axes along the line of action", f.acceleration.line_of_action, 1, "m/s²");
  row("of the axes, axial", f.acceleration.axial, 1, "m/s²");
  const auto motion = [&](const char* head, const dynamics::MotionFigures& m) {
    table.rows.push_back({head});
    plain("mean", 1e6 * m.mean, "µm");
    row("peak to peak", m.peak_to_peak, 1e6, "µm");
    row("largest", m.largest, 1e6, "µm");
  };
  motion("Transmission error u₁ + u₂ at the base circles", f.dynamic.transmission_error);
  motion("The same, quasi-static", f.quasi_static.transmission_error);
  motion("Relative motion with the bending of shafts and bearings, y₁ + u₁ – y₂ + u₂", f.dynamic.relative);
  section.blocks =
      paragraph(fmt::format(
          "At {} N m and {} r/min of the pinion, error at mesh frequency {} µm. ± is the estimated numerical error{}; "
          "it "
          "does not contain the uncertainty of the inputs.",
          to_text(result.scene.stage.pinion_torque), to_text(result.scene.stage.pinion_speed / units::rpm, 6),
          to_text(1e6 * result.errors.amplitude, 4),
          result.mesh.computed ? ", of the solution in time and of the stiffness table together"
          : result.mesh.table  ? ", of the solution in time and of the phases of the stiffness table; its own error is "
                                 "not known"
                               : "")) +
      table;
  return section;
}

Section pair_motion_section(const PairRunResult& result) {
  Section section{"motion", "Time history"};
  if (!result.response) return section;
  const auto& csv = result.response->series;
  const auto& f = result.response->figures;
  const auto per_cycle = csv.rows.size() / static_cast<std::size_t>(std::max(1, f.window_cycles));
  const auto rows = static_cast<std::size_t>(shown_pair_cycles) * per_cycle + 1;
  auto cycles = scaled_column(csv, "time_s", rows, f.mesh_frequency);
  const double begin = cycles.empty() ? 0 : cycles.front();
  for (auto& x : cycles) x -= begin;
  const auto plot = [&](const char* title, const char* y_label, const std::string& column, double scale,
                        std::size_t colour) {
    return Plot{.title = title,
                .x_label = "mesh cycles",
                .y_label = y_label,
                .series = {{.x = cycles, .y = scaled_column(csv, column, rows, scale), .colour = colour}}};
  };
  auto force = plot("Mesh force", "kN", "mesh_force_N", 1e-3, 0);
  force.levels.emplace_back(f.static_force / 1e3, "static");
  auto te = plot("Transmission error u₁ + u₂", "µm", "transmission_error_m", 1e6, 1);
  Plot axes{.title = "Axes of the gears about their mean", .x_label = "mesh cycles", .y_label = "µm", .legend = true};
  std::size_t colour = 0;
  for (const auto& [name, label] : {std::pair{"pinion_y_m", "pinion y"},
                                    {"pinion_z_m", "pinion z"},
                                    {"wheel_y_m", "wheel y"},
                                    {"wheel_z_m", "wheel z"}}) {
    ++colour;
    if (std::find(csv.columns.begin(), csv.columns.end(), name) == csv.columns.end()) continue;  // rigid bearing
    auto y = scaled_column(csv, name, rows, 1e6);
    double mean = 0;
    for (const double v : y) mean += v / static_cast<double>(y.size());
    for (double& v : y) v -= mean;
    axes.series.push_back({.label = label, .x = cycles, .y = std::move(y), .colour = colour});
  }
  Plot spectrum{.title = "Spectrum of the mesh force", .x_label = "multiple of the mesh frequency", .y_label = "kN"};
  Series lines{.colour = 0, .style = Series::Style::bars};
  for (const auto& row : result.response->spectrum.rows) {
    if (row[1] <= 0) continue;  // the mean
    lines.x.push_back(row[1]);
    lines.y.push_back(row[2] / 1e3);
  }
  spectrum.series.push_back(std::move(lines));
  std::vector<Picture> pictures = {force, te};
  if (!axes.series.empty()) pictures.emplace_back(axes);
  pictures.emplace_back(spectrum);
  section.blocks = Pictures{pictures,
                            {},
                            phrase("The first mesh cycles of the evaluated window at the operating point; whole window "
                                   "of {} mesh cycles: {}.",
                                   f.window_cycles, code("dynamics/time_series.csv"))};
  return section;
}

Section pair_modes_section(const PairRunResult& result) {
  Section section{"modes", "Natural frequencies"};
  if (!result.response) return section;
  const auto& modes = result.response->modes;
  const auto system = dynamics::assemble(*result.pair);
  const double stiffness = dynamics::mean_tangent_stiffness(result.pair->mesh);
  PageTable table{.head = {"mode", "frequency, Hz", "speed at which the mesh meets it, r/min", "strain in the mesh"},
                  .style = PageTable::Style::numbers};
  for (auto dof : modes.dofs) {
    std::replace(dof.begin(), dof.end(), '_', ' ');
    table.head.emplace_back(dof);
  }
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    const auto& mode = modes.modes[i];
    const bool free = mode.frequency == 0;
    const double omega = 2 * std::numbers::pi * mode.frequency, approach = system.mesh_vector(0).dot(mode.shape);
    std::vector<Text> cells = {
        fmt::format("{}", i + 1), free ? "0 " + muted("free rotation") : Text(fmt::format("{:.1f}", mode.frequency)),
        free ? "–" : fmt::format("{:.0f}", 60 * mode.frequency / result.scene.pinion.teeth),
        free ? "–" : fmt::format("{:.0f} %", 100 * stiffness * approach * approach / (omega * omega))};
    for (Eigen::Index k = 0; k < mode.shape.size(); ++k)
      cells.emplace_back(fmt::format("{:.0f} %", 100 * system.mass()(k, k) * mode.shape[k] * mode.shape[k]));
    table.rows.push_back(std::move(cells));
  }
  section.blocks =
      paragraph(
          "With the mean mesh stiffness, undamped. Strain in the mesh: its share of the elastic energy, what makes a "
          "mode answer to the mesh. The last columns are the shares of the kinetic energy.") +
      table;
  return section;
}

Section pair_quality_section(const PairRunResult& result) {
  Blocks blocks;
  if (result.response) blocks = solution_checks({{"pair", &result.response->figures}});
  return {"quality", "Checks and cost", blocks + cost_blocks(result)};
}

}  // namespace annulus::app
