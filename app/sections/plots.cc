#include <algorithm>
#include <cmath>

#include "app/sections/report_parts.h"

namespace annulus::app {

Plot wide_plot(const std::string& title, const std::string& x_label, const std::string& y_label, int height) {
  return {.title = title, .x_label = x_label, .y_label = y_label, .legend = true, .width = 900, .height = height};
}

std::vector<Picture> on_one_scale(std::vector<Plot> plots) {
  RangeFinder range;
  for (const auto& plot : plots) {
    for (const auto& [level, label] : plot.levels) range.add(level);
    for (const auto& series : plot.series)
      for (const auto* values : {&series.y, &series.low, &series.high}) range.add(*values);
  }
  std::vector<Picture> pictures;
  for (auto& plot : plots) {
    plot.y_range = range.range();
    pictures.emplace_back(std::move(plot));
  }
  return pictures;
}

std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to, double scale) {
  const auto column = csv.column(name);
  std::vector<double> list;
  for (const auto& row : csv.rows)
    if (row[0] < rows_to) list.push_back(scale == 1 ? row[column] : scale * row[column]);
  return list;
}

Plot line_plot(Plot frame, const Csv& csv, const LineTable& table, const std::vector<Line>& lines) {
  const auto values = [&](const std::string& column, double offset) {
    if (column.empty()) return std::vector<double>{};
    auto list = column_values(csv, column, table.rows_to);
    for (auto& v : list) v = (v - offset) * table.y_scale;
    return list;
  };
  const auto x = column_values(csv, table.x, table.rows_to, table.x_scale);
  for (const auto& line : lines)
    frame.series.push_back({.label = line.label,
                            .x = x,
                            .y = values(line.column, line.offset),
                            .low = values(line.low, line.offset),
                            .high = values(line.high, line.offset),
                            .colour = line.colour,
                            .style = line.style,
                            .dashed = line.dashed});
  return frame;
}

bool shows_something(const Plot& plot) {
  return std::any_of(plot.series.begin(), plot.series.end(), [](const Series& series) {
    return std::any_of(series.y.begin(), series.y.end(), [](double v) { return std::isfinite(v) && v != 0; });
  });
}

}  // namespace annulus::app
