#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

constexpr std::size_t most_lines = 8;  // more cannot be told apart by their colours

/// Rows of the grid that get a line: first, last and equal steps between.
std::vector<std::size_t> shown_rows(std::size_t rows) {
  std::vector<std::size_t> list;
  const std::size_t lines = std::min(rows, most_lines);
  for (std::size_t i = 0; i < lines; ++i) list.push_back(lines == 1 ? 0 : i * (rows - 1) / (lines - 1));
  return list;
}

/// One figure over x, a line for each shown y; nothing when the figure is nowhere known or zero throughout.
std::optional<Plot> lines_picture(const GridResult& grid, const std::vector<StudyPoint>& points,
                                  const FigureSpec& figure) {
  Plot plot{
      .title = figure.title, .x_label = with_unit(grid.grid.x.input, grid.x_unit), .y_label = figure.axis_label()};
  plot.x_log = grid.grid.x.scale == SweepScale::logarithmic;
  bool any = false;
  const auto rows = shown_rows(grid.y.size());
  for (std::size_t line = 0; line < rows.size(); ++line) {
    Series series{.label = to_text(grid.y[rows[line]], 5) + " " + grid.y_unit, .x = grid.x, .colour = line};
    for (std::size_t i = 0; i < grid.x.size(); ++i) {
      series.y.push_back(figure.scale * points[rows[line] * grid.x.size() + i].value(figure.key));
      any = any || (std::isfinite(series.y.back()) && series.y.back() != 0);
    }
    plot.series.push_back(std::move(series));
  }
  return any ? std::optional(plot) : std::nullopt;
}

Blocks one_grid(const Scene& scene, const StudyResults& studies, std::size_t n) {
  const auto& grid = studies.grids[n];
  int failed = 0, not_steady = 0;
  for (const auto& variant : grid.variants) {
    for (const auto& point : variant) {
      failed += point.failure.empty() ? 0 : 1;
      not_steady += point.failure.empty() && point.value("steady") == 0 ? 1 : 0;
    }
  }
  Blocks blocks =
      heading(grid.grid.x.input + " and " + grid.grid.y.input) +
      paragraph(phrase("{} {} {} × {} points; all else as in the scene. Table: {}.{}{}",
                       find_input(scene, grid.grid.x.input).parameter->meaning,
                       find_input(scene, grid.grid.y.input).parameter->meaning, grid.x.size(), grid.y.size(),
                       code(fmt::format("dynamics/grid_{}.csv", n + 1)),
                       failed ? fmt::format(" {} responses failed and are left out.", failed) : "",
                       not_steady ? fmt::format(" {} responses did not become periodic; their figures hold for the "
                                                "window only.",
                                                not_steady)
                                  : ""));
  Legend legend;
  for (const std::size_t row : shown_rows(grid.y.size()))
    legend.emplace_back(to_text(grid.y[row], 5) + " " + grid.y_unit, legend.size());
  for (std::size_t variant = 0; variant < studies.variants.size(); ++variant) {
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < studies.figures.size(); ++i) {
      if (!studies.figures[i].plotted) continue;
      if (const auto picture = lines_picture(grid, grid.variants[variant], studies.figures[i]))
        pictures.emplace_back(*picture);
    }
    const auto& name = studies.variants[variant];
    blocks += Pictures{pictures, legend,
                       (name.empty() ? "" : name + ". ") + "One line for each value of " + grid.grid.y.input +
                           (grid.y.size() > most_lines ? " (some of them)." : ".")};
  }
  return blocks;
}

}  // namespace

Section grids_section(const Scene& scene, const StudyResults& studies) {
  Section section{"grids", "Grids"};
  for (std::size_t n = 0; n < studies.grids.size(); ++n) section.blocks += one_grid(scene, studies, n);
  return section;
}

}  // namespace annulus::app
