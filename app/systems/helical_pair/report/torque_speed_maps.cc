#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene/overrides.h"
#include "app/study/study_subject.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"

namespace annulus::app {

namespace {

struct MapAxis {
  std::string label;
  std::vector<double> values;      ///< in the unit of the label
  std::vector<Range> cells;        ///< halfway to the neighbours
  std::vector<std::size_t> order;  ///< rising values
};

MapAxis map_axis(const SweepInput& input, const std::vector<double>& values, const std::string& unit) {
  MapAxis axis{.label = with_unit(input.input, unit), .values = values, .cells = {}, .order = {}};
  if (input.input == "stage.pinion_torque_Nm") {
    axis.label = "torque of the pinion, kN m";
    for (auto& v : axis.values) v /= 1e3;
  } else if (input.input == "stage.pinion_speed_rpm") {
    axis.label = "speed of the pinion, r/min";
  }
  for (std::size_t i = 0; i < values.size(); ++i) axis.order.push_back(i);
  std::sort(axis.order.begin(), axis.order.end(),
            [&](std::size_t a, std::size_t b) { return axis.values[a] < axis.values[b]; });
  axis.cells.resize(values.size());
  for (std::size_t k = 0; k < axis.order.size(); ++k) {
    const double here = axis.values[axis.order[k]];
    const auto half = [&](std::size_t other) { return (axis.values[axis.order[other]] + here) / 2; };
    const bool single = axis.order.size() == 1;
    const double low = k > 0 ? half(k - 1) : single ? here - 0.5 : 2 * here - half(k + 1);
    const double high = k + 1 < axis.order.size() ? half(k + 1) : single ? here + 0.5 : 2 * here - half(k - 1);
    axis.cells[axis.order[k]] = {low, high};
  }
  return axis;
}

/// Nothing when the result is nowhere known or zero throughout.
std::optional<ColourMap> one_map(const GridResult& grid, const FigureSpec& figure) {
  const auto x = map_axis(grid.grid.x, grid.x, grid.x_unit), y = map_axis(grid.grid.y, grid.y, grid.y_unit);
  RangeFinder values;
  ColourMap::Panel panel{.x_range = {x.cells[x.order.front()].low, x.cells[x.order.back()].high}};
  bool any = false, gap = false;
  for (const auto j : y.order) {
    for (const auto i : x.order) {
      const double value = figure.scale * grid.variants.front()[j * grid.x.size() + i].value(figure.key);
      ColourMap::Cell cell{.x = x.cells[i], .y = y.cells[j]};
      if (std::isfinite(value)) {
        cell.value = value;
        values.add(value);
        any = any || value != 0;
      } else {
        gap = true;
      }
      panel.cells.push_back(cell);
    }
  }
  if (!any) return std::nullopt;
  return ColourMap{.title = figure.title,
                   .x_label = x.label,
                   .y_label = y.label,
                   .value_label = figure.axis_label(),
                   .y_range = {y.cells[y.order.front()].low, y.cells[y.order.back()].high},
                   .values = values.range(0),
                   .grey = gap ? "failed" : "",
                   .panels = {panel},
                   .width = 430,
                   .height = 300};
}

/// Where the teeth lose contact, and where the largest acceleration lies.
Paragraph map_words(const GridResult& grid) {
  constexpr const char *loss = "contact_loss", *acceleration = "acceleration_max_m_per_s2";
  const auto& points = grid.variants.front();
  int parted = 0;
  std::size_t top = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    parted += points[i].value(loss) > 0 ? 1 : 0;
    if (points[i].value(acceleration) > points[top].value(acceleration) || std::isnan(points[top].value(acceleration)))
      top = i;
  }
  const auto nx = grid.x.size();
  return {fmt::format(
      "The acceleration is largest, {} m/s², at {} {} and {} {}. The teeth lose contact at {} of {} points.",
      to_text(points[top].value(acceleration), 4), to_text(grid.x[top % nx], 5), grid.x_unit,
      to_text(grid.y[top / nx], 5), grid.y_unit, parted, points.size())};
}

}  // namespace

Section pair_maps_section(const PairRunResult& result) {
  Section section{"maps", "Torque and speed"};
  const auto& studies = result.studies;
  for (std::size_t n = 0; n < studies.grids.size(); ++n) {
    const auto& grid = studies.grids[n];
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < studies.figures.size(); ++i) {
      if (!studies.figures[i].plotted) continue;
      if (const auto picture = one_map(grid, studies.figures[i])) pictures.emplace_back(*picture);
    }
    if (pictures.empty()) continue;
    section.blocks +=
        map_words(grid) +
        Pictures{
            pictures,
            {},
            phrase("{} × {} responses, {}; the same numbers as lines stand under {}. The paper shows acceleration, "
                   "mesh force and transmission error this way (figures 4 to 6).",
                   grid.x.size(), grid.y.size(), code(fmt::format("dynamics/grid_{}.csv", n + 1)),
                   link("Grids", "grids"))};
  }
  return section;
}

}  // namespace annulus::app
