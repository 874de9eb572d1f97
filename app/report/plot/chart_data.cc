#include <fmt/format.h>

#include <cmath>

#include "app/report/plot/chart.h"

namespace annulus::app {

namespace {

using nlohmann::json;
using Kind = Mark::Kind;

json numbers(const std::vector<double>& values, const std::vector<std::size_t>& points) {
  auto list = json::array();
  for (const std::size_t i : points) list.push_back(plot_number(values[i]));
  return list;
}

json axis_data(const Axis& axis) {
  json data = {
      {"label", axis.label}, {"range", {plot_number(axis.range.low), plot_number(axis.range.high)}}, {"log", axis.log}};
  if (!axis.names.empty()) data["names"] = axis.names;
  return data;
}

/// A dataset of Chart.js, whose points page.js puts together.
json mark_data(const Mark& mark) {
  constexpr double steps = 1000;
  const bool dots = mark.kind == Kind::dots || mark.kind == Kind::diamonds;
  const auto step_of = [&](std::size_t i) {
    return std::floor(static_cast<double>(i) * steps / static_cast<double>(mark.x.size()));
  };
  const auto points = dots ? distinct_dots(mark) : reduced_points(mark, mark.y, steps, step_of);
  const std::string pale =
      mark.opacity < 1 ? fmt::format("{}{:02x}", mark.colour, std::lround(255 * mark.opacity)) : mark.colour;
  json data = {{"label", mark.label},         {"named", mark.in_legend},
               {"group", mark.group},         {"borderColor", mark.kind == Kind::shape ? mark.colour : pale},
               {"backgroundColor", pale},     {"x", numbers(mark.x, points)},
               {"y", numbers(mark.y, points)}};
  if (!mark.low.empty()) data.update({{"low", numbers(mark.low, points)}, {"high", numbers(mark.high, points)}});
  if (mark.error > 0) data["error"] = plot_number(mark.error);
  switch (mark.kind) {
    case Kind::line:
      data.update({{"borderWidth", mark.size}, {"borderDash", mark.dash}});
      break;
    case Kind::diamonds:
      data["pointStyle"] = "rectRot";
      [[fallthrough]];
    case Kind::dots:
      data.update({{"showLine", false}, {"pointRadius", mark.size / 2}, {"borderWidth", 0}});
      break;
    case Kind::stems:
      data.update({{"type", "bar"}, {"barThickness", mark.size}, {"grouped", false}});
      break;
    case Kind::shape:
      data.update({{"fill", "shape"}, {"borderWidth", mark.size}});
      break;
  }
  return data;
}

json panel_data(const Panel& panel) {
  json data = {{"title", panel.title},
               {"x", axis_data(panel.x)},
               {"y", axis_data(panel.y)},
               {"sets", json::array()},
               {"cells", json::array()}};
  for (const auto& mark : panel.marks) data["sets"].push_back(mark_data(mark));
  for (const auto& [x, y, value] : panel.cells)
    data["cells"].push_back({plot_number(x.low), plot_number(x.high), plot_number(y.low), plot_number(y.high),
                             value ? plot_number(*value) : json()});
  return data;
}

}  // namespace

json plot_number(double value) { return std::isfinite(value) ? json(significant(value, 6)) : json(); }

json plot_data(const Chart& chart) {
  json data = {{"title", chart.title}, {"panels", json::array()}};
  for (const auto& panel : chart.panels) data["panels"].push_back(panel_data(panel));
  if (const auto& scale = chart.scale)
    data["scale"] = {{"label", scale->label},
                     {"range", {plot_number(scale->range.low), plot_number(scale->range.high)}},
                     {"colours", scale->colours},
                     {"grey", scale->grey},
                     {"no_value", scale->of({})}};
  return data;
}

}  // namespace annulus::app
