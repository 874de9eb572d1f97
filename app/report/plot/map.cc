#include "app/report/plot/map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/report/plot/colour_scale.h"
#include "app/report/plot/frame.h"
#include "app/report/plot/plot_data.h"
#include "app/report/text/xml.h"

namespace annulus::app {

namespace {

constexpr const char* grey_fill = "#bcc2c7";
constexpr int levels = colour_levels;
constexpr int no_value = -1;

/// The step of a value on the scale.
int level_of(const ColourScale& scale, const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return no_value;
  const double at = (*value - scale.range.low) / (scale.range.high - scale.range.low);
  return std::clamp(static_cast<int>(at * levels), 0, levels - 1);
}

const std::string& colour(const ColourScale& scale, int level) {
  return level == no_value ? scale.no_value : scale.colours[static_cast<std::size_t>(level)];
}

/// All cells of one panel, one path per colour; runs of equal neighbours in x joined.
std::string cells(const Frame& frame, const std::vector<ColourMap::Cell>& list, const ColourScale& scale) {
  std::map<int, std::string> paths;
  for (std::size_t i = 0; i < list.size();) {
    const auto& first = list[i];
    const int level = level_of(scale, first.value);
    double end = first.x.high;
    std::size_t next = i + 1;
    for (; next < list.size(); ++next) {
      const auto& cell = list[next];
      if (cell.x.low != end || cell.y.low != first.y.low || cell.y.high != first.y.high ||
          level_of(scale, cell.value) != level)
        break;
      end = cell.x.high;
    }
    const double x = frame.at_x(first.x.low), y = frame.at_y(first.y.high);
    paths[level] +=
        fmt::format("M{:.1f} {:.1f}H{:.1f}V{:.1f}H{:.1f}Z", x, y, frame.at_x(end), frame.at_y(first.y.low), x);
    i = next;
  }
  std::string svg = "<g shape-rendering=\"crispEdges\">";
  for (const auto& [level, d] : paths) svg += fmt::format("<path fill=\"{}\" d=\"{}\"/>", colour(scale, level), d);
  return svg + "</g>";
}

std::string line(const Frame& frame, const std::vector<std::pair<double, double>>& points) {
  std::string d;
  bool pen_down = false;
  for (const auto& [x, y] : points) {
    const bool there = std::isfinite(x) && std::isfinite(y);
    if (there) d += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", frame.at_x(x), frame.at_y(y));
    pen_down = there;
  }
  return fmt::format(
      "<path d=\"{0}\" fill=\"none\" stroke=\"#fff\" stroke-width=\"3\" stroke-opacity=\"0.7\"/>"
      "<path d=\"{0}\" fill=\"none\" stroke=\"#111\" stroke-width=\"1.2\"/>",
      d);
}

/// The scale as a bar from bottom to top, with ticks, and the grey of cells without a value below it.
std::string colour_bar(const ColourMap& map, const ColourScale& scale, double left, double top, double bottom) {
  constexpr double width = 12;
  if (!map.grey.empty()) bottom -= 26;
  const Frame bar{left, left + width, top, bottom, {0, 1}, scale.range};
  std::string svg;
  const double step = (bottom - top) / levels;
  for (int i = 0; i < levels; ++i) {
    svg += fmt::format("<path fill=\"{}\" d=\"M{:.1f} {:.2f}h{:.1f}v{:.2f}h{:.1f}Z\"/>", colour(scale, i), left,
                       bottom - (i + 1) * step - 0.2, width, step + 0.4, -width);
  }
  const auto ticks = nice_ticks(bar.y.low, bar.y.high, static_cast<int>((bottom - top) / 34));
  const auto labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i)
    svg +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", left + width + 5, bar.at_y(ticks[i]) + 3.5, labels[i]);
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", map.width - 2.0, top - 8,
                     escape(map.value_label));
  if (!map.grey.empty()) {
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\" fill=\"{}\" stroke=\"#aaa\" "
        "stroke-width=\"0.5\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
        left, bottom + 13, width, grey_fill, left + width + 5, bottom + 22.5, escape(map.grey));
  }
  return svg;
}

}  // namespace

ColourScale colour_scale(const ColourMap& map) {
  const bool diverging = map.values.low < 0;
  ColourScale scale{.range = map.values, .colours = {}, .no_value = grey_fill};
  if (diverging) {
    const double most = std::max(std::abs(map.values.low), std::abs(map.values.high));
    scale.range = {-most, most};
  }
  for (int level = 0; level < levels; ++level) {
    const double at = static_cast<double>(level) / (levels - 1);
    scale.colours.push_back(diverging ? both_ways_colour(at) : one_way_colour(at));
  }
  return scale;
}

std::string to_svg(const ColourMap& map) {
  constexpr double left = 62, bar_space = 92, between = 16;
  const ColourScale scale = colour_scale(map);
  const bool panel_titles =
      std::any_of(map.panels.begin(), map.panels.end(), [](const auto& p) { return !p.title.empty(); });
  const double top = (map.title.empty() ? 22 : 40) + (panel_titles ? 2 : 0), bottom = map.height - 42.0;
  std::string svg = open_svg(map.title, map.width, map.height, left);
  const auto count = static_cast<double>(std::max<std::size_t>(1, map.panels.size()));
  const double width = (map.width - left - bar_space - between * (count - 1)) / count;
  double x = left;
  for (const auto& panel : map.panels) {
    const Frame frame{x, x + width, top, bottom, panel.x_range, map.y_range};
    // Only the first panel tells what is upright.
    const std::optional<int> ticks = x > left ? 0 : map.y_ticks;
    svg += axes(frame, map.x_label, x == left ? map.y_label : "", ticks) + cells(frame, panel.cells, scale);
    if (!panel.line.empty()) svg += line(frame, panel.line);
    if (!panel.title.empty())
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x, top - 7, escape(panel.title));
    x += width + between;
  }
  return svg + colour_bar(map, scale, map.width - bar_space + 14, top, bottom) + "</svg>";
}

namespace {

/// The ends of all cells in one direction, each once: cells name them by their place in this list.
class Edges {
 public:
  Edges(const std::vector<ColourMap::Cell>& cells, Range ColourMap::Cell::*direction) : direction_(direction) {
    for (const auto& cell : cells) {
      values_.push_back((cell.*direction).low);
      values_.push_back((cell.*direction).high);
    }
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
  }

  [[nodiscard]] std::pair<std::ptrdiff_t, std::ptrdiff_t> of(const ColourMap::Cell& cell) const {
    return {place((cell.*direction_).low), place((cell.*direction_).high)};
  }
  [[nodiscard]] nlohmann::json json() const { return plot_numbers(values_); }

 private:
  [[nodiscard]] std::ptrdiff_t place(double value) const {
    return std::lower_bound(values_.begin(), values_.end(), value) - values_.begin();
  }

  Range ColourMap::Cell::*direction_;
  std::vector<double> values_;
};

nlohmann::json panel_json(const ColourMap::Panel& panel) {
  const Edges x(panel.cells, &ColourMap::Cell::x), y(panel.cells, &ColourMap::Cell::y);
  nlohmann::json json = {{"title", panel.title},
                         {"x_range", {plot_number(panel.x_range.low), plot_number(panel.x_range.high)}},
                         {"x_edges", x.json()},
                         {"y_edges", y.json()}};
  auto cells = nlohmann::json::array(), line = nlohmann::json::array();
  for (const auto& cell : panel.cells) {
    const auto [left, right] = x.of(cell);
    const auto [low, high] = y.of(cell);
    cells.push_back({left, right, low, high, cell.value ? plot_number(*cell.value) : nlohmann::json(nullptr)});
  }
  for (const auto& [at, value] : panel.line) line.push_back({plot_number(at), plot_number(value)});
  json["cells"] = std::move(cells);
  json["line"] = std::move(line);
  return json;
}

}  // namespace

nlohmann::json plot_data(const ColourMap& map) {
  const auto scale = colour_scale(map);
  nlohmann::json data = {{"kind", "map"},
                         {"title", map.title},
                         {"x_label", map.x_label},
                         {"y_label", map.y_label},
                         {"value_label", map.value_label},
                         {"grey", map.grey},
                         {"y_range", {plot_number(map.y_range.low), plot_number(map.y_range.high)}},
                         {"scale", {plot_number(scale.range.low), plot_number(scale.range.high)}},
                         {"colours", scale.colours},
                         {"no_value", scale.no_value},
                         {"panels", nlohmann::json::array()}};
  for (const auto& panel : map.panels) data["panels"].push_back(panel_json(panel));
  return data;
}

}  // namespace annulus::app
