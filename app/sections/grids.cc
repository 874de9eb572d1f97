#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

/// One axis of a grid.
struct GridAxis {
  std::string label;
  std::vector<std::size_t> order;  ///< rising values
  std::vector<Range> cells;        ///< halfway to the neighbours

  [[nodiscard]] Range range() const { return {cells[order.front()].low, cells[order.back()].high}; }
};

GridAxis grid_axis(const std::string& input, const std::vector<double>& values, const std::string& unit) {
  GridAxis axis{.label = with_unit(input, unit), .order = {}, .cells = std::vector<Range>(values.size())};
  axis.order.resize(values.size());
  std::iota(axis.order.begin(), axis.order.end(), std::size_t{0});
  std::sort(axis.order.begin(), axis.order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const std::size_t last = values.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const double here = values[axis.order[k]];
    const auto half = [&](std::size_t other) { return (values[axis.order[other]] + here) / 2; };
    const double below = k > 0 ? half(k - 1) : last == 0 ? here - 0.5 : 2 * here - half(k + 1);
    const double above = k < last ? half(k + 1) : last == 0 ? here + 0.5 : 2 * here - half(k - 1);
    axis.cells[axis.order[k]] = {below, above};
  }
  return axis;
}

/// The pictures of one variant of a grid. Nothing for a result that is nowhere known or zero throughout.
class GridPictures {
 public:
  GridPictures(const GridResult& grid, std::size_t variant)
      : grid_(grid),
        points_(grid.variants[variant]),
        x_(grid_axis(grid.grid.x.input, grid.x, grid.x_unit)),
        y_(grid_axis(grid.grid.y.input, grid.y, grid.y_unit)) {}

  /// Over x, a line for each shown y.
  [[nodiscard]] std::optional<Plot> lines(const FigureSpec& figure) const {
    Plot plot{.title = figure.title,
              .x_label = x_.label,
              .y_label = figure.axis_label(),
              .x_log = grid_.grid.x.scale == SweepScale::logarithmic};
    const auto names = line_names(grid_);
    for (std::size_t line = 0; line < names.size(); ++line) {
      Series series{.label = names[line], .x = grid_.x, .colour = line};
      for (std::size_t i = 0; i < grid_.x.size(); ++i)
        series.y.push_back(value(figure, i, shown_rows(grid_.y.size())[line]));
      plot.series.push_back(std::move(series));
    }
    return shows_something(plot) ? std::optional(plot) : std::nullopt;
  }

  [[nodiscard]] std::optional<ColourMap> map(const FigureSpec& figure) const {
    RangeFinder values;
    ColourMap::Panel panel{.x_range = x_.range()};
    bool any = false, gap = false;
    for (const auto j : y_.order)
      for (const auto i : x_.order) {
        const double v = value(figure, i, j);
        auto& cell = panel.cells.emplace_back(ColourMap::Cell{.x = x_.cells[i], .y = y_.cells[j]});
        gap = gap || !std::isfinite(v);
        if (!std::isfinite(v)) continue;
        cell.value = v;
        values.add(v);
        any = any || v != 0;
      }
    if (!any) return std::nullopt;
    return ColourMap{.title = figure.title,
                     .x_label = x_.label,
                     .y_label = y_.label,
                     .value_label = figure.axis_label(),
                     .y_range = y_.range(),
                     .values = values.range(0),
                     .grey = gap ? "failed" : "",
                     .panels = {panel},
                     .width = 430,
                     .height = 300};
  }

  static constexpr std::size_t most_lines = 8;  // more have no distinct colours
  [[nodiscard]] static std::vector<std::string> line_names(const GridResult& grid) {
    std::vector<std::string> names;
    for (const std::size_t row : shown_rows(grid.y.size()))
      names.push_back(to_text(grid.y[row], 5) + " " + grid.y_unit);
    return names;
  }

 private:
  /// Rows of the grid that get a line: first, last and equal steps between.
  [[nodiscard]] static std::vector<std::size_t> shown_rows(std::size_t rows) {
    std::vector<std::size_t> list;
    const std::size_t lines = std::min(rows, most_lines);
    for (std::size_t i = 0; i < lines; ++i) list.push_back(lines == 1 ? 0 : i * (rows - 1) / (lines - 1));
    return list;
  }
  [[nodiscard]] double value(const FigureSpec& figure, std::size_t i, std::size_t j) const {
    return figure.scale * points_[j * grid_.x.size() + i].value(figure.key);
  }

  const GridResult& grid_;
  const std::vector<StudyPoint>& points_;
  GridAxis x_, y_;
};

/// Where the first ordering result is largest.
std::string largest_text(const StudyResults& studies, const GridResult& grid, std::size_t variant) {
  const auto* figure = studies.ordering();
  if (!figure) return "";
  std::optional<std::size_t> top;
  const auto& points = grid.variants[variant];
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double v = points[i].value(figure->key);
        std::isfinite(v) && (!top || v > points[*top].value(figure->key)))
      top = i;
  if (!top) return "";
  int lost = 0;
  for (const auto& point : points) {
    bool separated = false;
    for (const auto& spec : studies.figures)
      separated = separated || (spec.key.ends_with("contact_loss") && point.value(spec.key) > 0);
    lost += separated ? 1 : 0;
  }
  return fmt::format(" {}: at most {} {}, at {} {} and {} {}. The teeth lose contact at {} of {} points.",
                     figure->title, to_text(figure->scale * points[*top].value(figure->key), 4), figure->unit,
                     to_text(grid.x[*top % grid.x.size()], 5), grid.x_unit, to_text(grid.y[*top / grid.x.size()], 5),
                     grid.y_unit, lost, points.size());
}

Blocks one_grid(const Scene& scene, const StudyResults& studies, std::size_t n) {
  const auto& grid = studies.grids[n];
  StudyOutcome outcome;
  for (const auto& variant : grid.variants)
    for (const auto& point : variant) outcome.add(point, "");
  Blocks blocks = heading(grid.grid.x.input + " and " + grid.grid.y.input) +
                  paragraph(phrase("{} {} {} × {} points; all other inputs as in the scene. Table: {}.{}",
                                   find_input(scene, grid.grid.x.input).parameter->meaning,
                                   find_input(scene, grid.grid.y.input).parameter->meaning, grid.x.size(),
                                   grid.y.size(), code(fmt::format("dynamics/grid_{}.csv", n + 1)), outcome.text()));
  for (std::size_t variant = 0; variant < studies.variants.size(); ++variant) {
    const GridPictures draw(grid, variant);
    const auto& name = studies.variants[variant];
    blocks += Pictures{result_pictures(studies, [&](const FigureSpec& figure) { return draw.map(figure); }),
                       {},
                       (name.empty() ? "" : name + ".") + largest_text(studies, grid, variant)} +
              Pictures{result_pictures(studies, [&](const FigureSpec& figure) { return draw.lines(figure); }),
                       legend_of(GridPictures::line_names(grid)),
                       (name.empty() ? "" : name + ". ") + "One line for each value of " + grid.grid.y.input +
                           (grid.y.size() > GridPictures::most_lines ? " (some of them)." : ".")};
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
