#include "app/report/plot/bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/plot/frame.h"
#include "app/report/plot/plot_data.h"
#include "app/report/text/xml.h"

namespace annulus::app {

Range bar_range(const BarChart& chart) {
  double reach = chart.reach;
  bool negative = chart.two_sided, positive = chart.two_sided;
  for (const auto& bar : chart.bars) {
    if (!(chart.reach > 0))
      reach = std::max(reach, std::abs(bar.value) + (bar.error > 0 && std::isfinite(bar.error) ? bar.error : 0));
    negative = negative || bar.value < 0;
    positive = positive || bar.value > 0;
  }
  if (!(reach > 0)) reach = 1;
  return {negative ? -reach : 0, positive || !negative ? reach : 0};
}

std::string to_svg(const BarChart& chart) {
  const Range range = bar_range(chart);
  const bool negative = range.low < 0;
  const bool positive = range.high > 0;
  const bool notes =
      std::any_of(chart.bars.begin(), chart.bars.end(), [](const auto& bar) { return !bar.note.empty(); });
  const double top = chart.title.empty() ? 8 : 26, left = chart.label_width, note_width = notes ? 62 : 8;
  const double bottom = top + chart.row_height * static_cast<double>(chart.bars.size());
  const double note_left = negative ? note_width : 0, right = chart.width - (positive ? note_width : 8);
  const Frame frame{left + note_left, right, top, bottom, range, {0, 1}};
  const int height = static_cast<int>(bottom) + (chart.x_label.empty() ? 8 : 44);
  std::string svg = open_svg(chart.title, chart.width, height, 4);
  if (!chart.x_label.empty()) {
    const auto ticks = nice_ticks(frame.x.low, frame.x.high, static_cast<int>((frame.right - frame.left) / 60));
    const auto labels = tick_labels(ticks);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const double x = frame.at_x(ticks[i]);
      svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" stroke=\"#e4e4e4\"/>", x, top, bottom);
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x, bottom + 16, labels[i]);
    }
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
                       (frame.left + frame.right) / 2, bottom + 36, escape(chart.x_label));
  }
  const double zero = frame.at_x(0);
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const auto& bar = chart.bars[i];
    const double y = top + chart.row_height * (static_cast<double>(i) + 0.5), x = frame.at_x(bar.value);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left - 6, y + 4,
                       escape(bar.label));
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>",
                       std::min(x, zero), y - 0.36 * chart.row_height, std::abs(x - zero), 0.72 * chart.row_height,
                       palette(bar.colour));
    double end = x;
    if (bar.error > 0 && std::isfinite(bar.error)) {
      const double low = frame.at_x(bar.value - bar.error), high = frame.at_x(bar.value + bar.error);
      const double cap = 0.2 * chart.row_height;
      svg += fmt::format(
          "<path d=\"M{0:.1f} {2:.1f}v{3:.1f}M{1:.1f} {2:.1f}v{3:.1f}M{0:.1f} {4:.1f}H{1:.1f}\" stroke=\"#222\"/>", low,
          high, y - cap, 2 * cap, y);
      end = bar.value < 0 ? low : high;
    }
    if (!bar.note.empty())
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>",
                         bar.value < 0 ? end - 4 : end + 4, y + 4, bar.value < 0 ? "end" : "start", escape(bar.note));
  }
  svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" stroke=\"#888\"/>", zero, top, bottom);
  return svg + "</svg>";
}

nlohmann::json plot_data(const BarChart& chart) {
  nlohmann::json data = {
      {"kind", "bars"}, {"title", chart.title}, {"x_label", chart.x_label}, {"bars", nlohmann::json::array()}};
  const auto range = bar_range(chart);
  data["x_range"] = {plot_number(range.low), plot_number(range.high)};
  for (const auto& bar : chart.bars)
    data["bars"].push_back({{"label", bar.label},
                            {"colour", palette(bar.colour)},
                            {"value", plot_number(bar.value)},
                            {"error", plot_number(bar.error)}});
  return data;
}

}  // namespace annulus::app
