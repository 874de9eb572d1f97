#include "app/report/interactive_plot.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace annulus::app {

namespace {

/// Six digits are finer than any screen; what is not finite breaks a line.
nlohmann::json numbers(const std::vector<double>& values, const std::vector<std::size_t>& kept) {
  auto list = nlohmann::json::array();
  for (const std::size_t i : kept) {
    const double v = values[i];
    if (!std::isfinite(v)) {
      list.push_back(nullptr);
      continue;
    }
    if (v == 0) {
      list.push_back(0);
      continue;
    }
    const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(v))));
    list.push_back(std::isfinite(scale) && scale > 0 ? std::round(v * scale) / scale : v);
  }
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
  nlohmann::json data = {{"title", plot.title},
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
  // "</script>" and "<!--" within a text would end the element.
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return "<div class=\"plot\">" + to_svg(plot) + "<script type=\"application/json\">" + safe + "</script></div>";
}

}  // namespace annulus::app
