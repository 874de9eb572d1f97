#include "app/report/plot/frame.h"

#include <fmt/format.h>

#include "app/report/text/xml.h"
#include "app/scene/scene_value.h"

namespace annulus::app {

namespace {

std::vector<std::string> log_labels(const std::vector<double>& ticks) {
  std::vector<std::string> labels;
  labels.reserve(ticks.size());
  for (const double tick : ticks) labels.push_back(to_text(tick, 3));
  return labels;
}

}  // namespace

std::string y_axis(const Frame& frame, const std::string& y_label, std::optional<int> y_ticks) {
  std::string svg;
  const int fitting = static_cast<int>((frame.bottom - frame.top) / 38);
  const auto up = frame.y_log ? log_ticks(frame.y.low, frame.y.high)
                              : nice_ticks(frame.y.low, frame.y.high, y_ticks.value_or(fitting));
  const auto up_labels = frame.y_log ? log_labels(up) : tick_labels(up);
  for (std::size_t i = 0; i < up.size() && y_ticks != 0; ++i) {
    const double y = frame.at_y(up[i]);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#e4e4e4\"/>", frame.left, y, frame.right);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", frame.left - 6, y + 3.5,
                       up_labels[i]);
  }
  svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"#888\"/>", frame.left, frame.top,
                     frame.bottom, frame.right);
  svg += fmt::format("<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                     frame.left - 49, (frame.top + frame.bottom) / 2, escape(y_label));
  return svg;
}

std::string axes(const Frame& frame, const std::string& x_label, const std::string& y_label,
                 std::optional<int> y_ticks) {
  std::string svg;
  const auto x_ticks = frame.x_log
                           ? log_ticks(frame.x.low, frame.x.high)
                           : nice_ticks(frame.x.low, frame.x.high, static_cast<int>((frame.right - frame.left) / 60));
  const auto x_labels = frame.x_log ? log_labels(x_ticks) : tick_labels(x_ticks);
  svg += y_axis(frame, y_label, y_ticks);
  for (std::size_t i = 0; i < x_ticks.size(); ++i) {
    const double x = frame.at_x(x_ticks[i]);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}v4\" stroke=\"#888\"/>", x, frame.bottom);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x, frame.bottom + 16,
                       x_labels[i]);
  }
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", (frame.left + frame.right) / 2,
                     frame.bottom + 36, escape(x_label));
  return svg;
}

std::string open_svg(const std::string& title, int width, int height, double title_left, const std::string& label) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" "
      "font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"#333\">",
      width, height, escape(label.empty() ? title : label));
  if (!title.empty())
    svg += fmt::format("<text x=\"{:.1f}\" y=\"15\" font-size=\"13\" font-weight=\"600\">{}</text>", title_left,
                       escape(title));
  return svg;
}

}  // namespace annulus::app
