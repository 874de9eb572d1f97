#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"

namespace annulus::app {

namespace {

constexpr double shown_pair_cycles = 6;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Section pair_motion_section(const PairRunResult& result) {
  Section section{"motion", "Time history"};
  if (!result.response || result.response->series.rows.empty()) return section;
  const auto& csv = result.response->series;
  const auto& f = result.response->figures;
  const double begin = csv.rows.front()[0], end = begin + (shown_pair_cycles + 1e-6) / f.mesh_frequency;
  const auto plot = [&](Plot frame, double scale, const std::vector<Line>& lines) {
    frame.x_label = "mesh cycles";
    auto made = line_plot(std::move(frame), csv,
                          {.x = "time_s", .x_scale = f.mesh_frequency, .y_scale = scale, .rows_to = end}, lines);
    for (auto& series : made.series)
      for (auto& x : series.x) x -= begin * f.mesh_frequency;
    return made;
  };
  std::vector<Line> axes;
  std::size_t colour = 0;
  for (const auto& [name, label] : {std::pair{"pinion_x_m", "pinion x"},
                                    {"pinion_y_m", "pinion y"},
                                    {"pinion_z_m", "pinion z"},
                                    {"wheel_x_m", "wheel x"},
                                    {"wheel_y_m", "wheel y"},
                                    {"wheel_z_m", "wheel z"}}) {
    ++colour;
    if (std::find(csv.columns.begin(), csv.columns.end(), name) == csv.columns.end()) continue;  // rigid bearing
    axes.push_back(
        {.column = name, .label = label, .colour = colour, .offset = mean_of(column_values(csv, name, end))});
  }
  std::vector<Picture> pictures = {
      plot({.title = "Mesh force", .y_label = "kN", .levels = {{f.static_force / 1e3, "static"}}}, 1e-3,
           {{.column = "mesh_force_N"}}),
      plot({.title = "Transmission error u₁ + u₂", .y_label = "µm"}, 1e6,
           {{.column = "transmission_error_m", .colour = 1}})};
  if (!axes.empty())
    pictures.emplace_back(
        plot({.title = "Axes of the gears about their mean", .y_label = "µm", .legend = true}, 1e6, axes));
  Csv spectrum = result.response->spectrum;
  std::erase_if(spectrum.rows, [](const auto& row) { return row[1] <= 0; });  // the mean
  pictures.emplace_back(line_plot(
      {.title = "Spectrum of the mesh force", .x_label = "multiple of the mesh frequency", .y_label = "kN"}, spectrum,
      {.x = "mesh_order", .y_scale = 1e-3}, {{.column = "mesh_force_N", .style = Series::Style::bars}}));
  section.blocks =
      Pictures{pictures,
               {},
               phrase("The first mesh cycles of the evaluated window of {} at the operating point. More of "
                      "them: {}.",
                      f.window_cycles, code("dynamics/time_series.csv"))};
  section.blocks += space_blocks(result.response->space, "");
  return section;
}

Section pair_modes_section(const PairRunResult& result) {
  Section section{"modes", "Natural frequencies"};
  if (!result.response) return section;
  const auto& modes = result.response->modes;
  const auto system = dynamics::assemble(*result.pair);
  const double stiffness = dynamics::mean_tangent_stiffness(result.pair->mesh);
  PageTable table{.head = {"mode", "frequency, Hz", "pinion speed at resonance, r/min", "strain energy of the mesh"},
                  .style = PageTable::Style::numbers};
  for (auto dof : modes.dofs) {
    std::replace(dof.begin(), dof.end(), '_', ' ');
    table.head.emplace_back(dof);
  }
  for (const auto& mode : modes.modes) {
    const double omega = 2 * std::numbers::pi * mode.frequency, approach = system.mesh_vector(0).dot(mode.shape);
    auto& cells = table.rows.emplace_back(1, fmt::format("{}", table.rows.size() + 1));
    if (mode.frequency == 0) {
      cells.insert(cells.end(), {"0 " + muted("free rotation"), "–", "–"});
    } else {
      for (const auto& text : {fmt::format("{:.1f}", mode.frequency),
                               fmt::format("{:.0f}", 60 * mode.frequency / helical_pair(result.scene).pinion.teeth),
                               fmt::format("{:.0f} %", 100 * stiffness * approach * approach / (omega * omega))})
        cells.emplace_back(text);
    }
    for (Eigen::Index k = 0; k < mode.shape.size(); ++k)
      cells.emplace_back(fmt::format("{:.0f} %", 100 * system.mass()(k, k) * mode.shape[k] * mode.shape[k]));
  }
  section.blocks =
      paragraph(
          "Undamped modes with the mean mesh stiffness. Strain energy of the mesh: its share of the elastic energy. "
          "The mesh excites modes with a large share. The last columns are the shares of the kinetic energy.") +
      table;
  return section;
}

}  // namespace annulus::app
