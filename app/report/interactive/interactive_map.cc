#include <algorithm>

#include "app/report/interactive/plot_data.h"
#include "app/report/interactive_plot.h"

namespace annulus::app {

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

std::string plot_html(const ColourMap& map) {
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
  return with_plot_data(to_svg(map), data);
}

}  // namespace annulus::app
