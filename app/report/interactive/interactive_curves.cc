#include "app/report/interactive_plot.h"

#include <algorithm>

#include "app/report/interactive/plot_data.h"

namespace annulus::app {

namespace {

nlohmann::json numbers(const std::vector<double>& values, const std::vector<std::size_t>& kept) {
  auto list = nlohmann::json::array();
  for (const std::size_t i : kept) list.push_back(plot_number(values[i]));
  return list;
}

/// First, smallest, largest and last of each of many steps of a long series; all of a short one.
std::vector<std::size_t> kept_points(const Series& s) {
  constexpr std::size_t steps = 1000;
  std::vector<std::size_t> kept;
  if (s.x.size() <= 4 * steps || !std::is_sorted(s.x.begin(), s.x.end())) {
    for (std::size_t i = 0; i < s.x.size(); ++i) kept.push_back(i);
    return kept;
  }
  for (std::size_t step = 0; step < steps; ++step) {
    const std::size_t begin = step * s.x.size() / steps, end = (step + 1) * s.x.size() / steps;
    const auto [low, high] = std::minmax_element(s.y.begin() + static_cast<std::ptrdiff_t>(begin),
                                                 s.y.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<std::size_t> of_step = {begin, static_cast<std::size_t>(low - s.y.begin()),
                                        static_cast<std::size_t>(high - s.y.begin()), end - 1};
    std::sort(of_step.begin(), of_step.end());
    of_step.erase(std::unique(of_step.begin(), of_step.end()), of_step.end());
    kept.insert(kept.end(), of_step.begin(), of_step.end());
  }
  return kept;
}

const char* style_name(Series::Style style) {
  switch (style) {
    case Series::Style::line:
      return "line";
    case Series::Style::dots:
      return "dots";
    case Series::Style::bars:
      break;
  }
  return "bars";
}

}  // namespace

std::string plot_html(const Plot& plot) {
  nlohmann::json data = {{"kind", "curves"},
                         {"title", plot.title},
                         {"x_label", plot.x_label},
                         {"y_label", plot.y_label},
                         {"x_log", plot.x_log},
                         {"y_log", plot.y_log},
                         {"series", nlohmann::json::array()},
                         {"levels", nlohmann::json::array()}};
  if (plot.x_range) data["x_range"] = {plot.x_range->low, plot.x_range->high};
  if (plot.y_range) data["y_range"] = {plot.y_range->low, plot.y_range->high};
  for (const auto& s : plot.series) {
    const auto kept = kept_points(s);
    nlohmann::json series = {
        {"label", s.label}, {"colour", palette(s.colour)}, {"style", style_name(s.style)}, {"dashed", s.dashed},
        {"size", s.size},   {"x", numbers(s.x, kept)},     {"y", numbers(s.y, kept)}};
    if (!s.low.empty() && s.low.size() == s.x.size() && s.high.size() == s.x.size()) {
      series["low"] = numbers(s.low, kept);
      series["high"] = numbers(s.high, kept);
    }
    data["series"].push_back(std::move(series));
  }
  for (const auto& [value, label] : plot.levels) data["levels"].push_back({{"value", value}, {"label", label}});
  return with_plot_data(to_svg(plot), data);
}

}  // namespace annulus::app
