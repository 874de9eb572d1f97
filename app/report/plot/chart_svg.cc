#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/report/plot/chart.h"
#include "app/report/text/svg.h"
#include "app/scene/scene_value.h"

namespace annulus::app {

namespace {

using svg::Point;
using Kind = Mark::Kind;

constexpr const char *axis_style = R"(fill="none" stroke="#888")", *grid_style = R"(stroke="#e4e4e4")";

double part(double value, const Axis& axis) {
  const auto& [low, high] = axis.range;
  return axis.log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

/// Page coordinates of a panel.
struct Frame {
  double left, right, top, bottom;
  const Axis &x, &y;
  [[nodiscard]] double at_x(double v) const { return left + part(v, x) * (right - left); }
  [[nodiscard]] double at_y(double v) const { return bottom - part(v, y) * (bottom - top); }
  [[nodiscard]] Point at(double u, double v) const { return {at_x(u), at_y(v)}; }
};

struct Tick {
  double at;
  std::string label;
};
/// About `fitting` of them.
std::vector<Tick> ticks_of(const Axis& axis, double fitting) {
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < axis.names.size(); ++i) ticks.push_back({static_cast<double>(i) + 0.5, axis.names[i]});
  if (!ticks.empty() || axis.ticks == 0) return ticks;
  const auto& [low, high] = axis.range;
  const auto at =
      axis.log ? log_ticks(low, high) : nice_ticks(low, high, axis.ticks.value_or(static_cast<int>(fitting)));
  const auto labels = tick_labels(at);
  for (std::size_t i = 0; i < at.size(); ++i) ticks.push_back({at[i], axis.log ? to_text(at[i], 3) : labels[i]});
  return ticks;
}

/// Grid lines stand on the axis of values, ticks on the other; rows with names have no frame.
std::string axes(const Frame& frame) {
  const bool rows = !frame.y.names.empty(), columns = !frame.x.names.empty(), plain = !rows && !columns;
  std::string text;
  for (const auto& [value, label] : ticks_of(frame.y, (frame.bottom - frame.top) / 38)) {
    const double y = frame.at_y(value);
    if (!rows) text += svg::line({frame.left, y}, {frame.right, y}, grid_style);
    text += svg::words({frame.left - frame.y.gap, y + 3.5}, label, svg::at_the_end);
  }
  if (rows && frame.x.label.empty()) return text;
  if (!rows)
    text += svg::path(svg::through({{frame.left, frame.top}, {frame.left, frame.bottom}, {frame.right, frame.bottom}}),
                      axis_style);
  for (const auto& [value, label] : ticks_of(frame.x, (frame.right - frame.left) / 60)) {
    const double x = frame.at_x(value);
    if (rows) text += svg::line({x, frame.top}, {x, frame.bottom}, grid_style);
    if (plain) text += svg::line({x, frame.bottom}, {x, frame.bottom + 4}, axis_style);
    text += svg::words({x, frame.bottom + 16}, label, svg::centred);
  }
  const Point middle(0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
  text += svg::words({middle.x(), frame.bottom + 36}, frame.x.label, svg::centred);
  const auto upright =
      fmt::format(R"-(transform="translate({:.1f} {:.1f}) rotate(-90)" )-", frame.left - 49, middle.y());
  return text + svg::words({0, 0}, frame.y.label, upright + svg::centred);
}

/// Points as a path, one tenth of a page unit fine; those that are not finite lift the pen.
std::string path(const Frame& frame, const Mark& mark, const std::vector<double>& y, bool backwards = false,
                 char first = 'M') {
  auto points = reduced_points(mark, y, frame.right - frame.left,
                               [&](std::size_t i) { return std::floor(frame.at_x(mark.x[i])); });
  if (backwards) std::reverse(points.begin(), points.end());
  std::string d;
  char next = first;
  for (const std::size_t i : points) {
    const Point p = frame.at(mark.x[i], y[i]);
    const bool there = p.allFinite();
    if (there) d += fmt::format("{}{:.1f} {:.1f}", next, p.x(), p.y());
    next = there ? 'L' : 'M';
  }
  return d;
}

/// Dots as lines of no length with round ends; those that fall on the same place of the page are drawn once.
std::string dots(const Frame& frame, const Mark& mark) {
  std::set<std::string> places;
  for (const std::size_t i : distinct_dots(mark)) {
    const Point p = frame.at(mark.x[i], mark.y[i]);
    if (!p.allFinite()) continue;
    const double half = mark.size / 2;
    places.insert(mark.kind == Kind::dots
                      ? fmt::format("M{:.1f} {:.1f}h0", p.x(), p.y())
                      : fmt::format("M{0:.1f} {1:.1f}l{2} -{2}l{2} {2}l-{2} {2}z", p.x() - half, p.y(), half));
  }
  return fmt::format("{}", fmt::join(places, ""));
}

std::string stems(const Frame& frame, const Mark& mark) {
  std::string d;
  const double base = std::clamp(frame.at_y(0), frame.top, frame.bottom);
  for (std::size_t i = 0; i < mark.x.size(); ++i) {
    const double top = frame.at_y(mark.y[i]);
    // A line no higher than half a pixel would only make the file larger.
    if (std::isfinite(top) && std::abs(top - base) > 0.5)
      d += fmt::format("M{:.1f} {:.1f}V{:.1f}", frame.at_x(mark.x[i]), base, top);
  }
  return d;
}

std::string stroke(const Mark& mark) {
  std::string style = fmt::format(R"(fill="none" stroke="{}" stroke-width="{}")", mark.colour, mark.size);
  if (mark.opacity < 1) style += fmt::format(R"( stroke-opacity="{}")", mark.opacity);
  if (!mark.dash.empty()) style += fmt::format(R"( stroke-dasharray="{}")", fmt::join(mark.dash, " "));
  return style;
}

std::string drawn(const Frame& frame, const Mark& mark) {
  const auto filled = [&](double opacity) {
    return fmt::format(R"(fill="{}" fill-opacity="{}" )", mark.colour, opacity);
  };
  std::string text = mark.in_legend ? "<title>" + escape(mark.label) + "</title>" : "";
  if (!mark.low.empty())
    text += svg::path(path(frame, mark, mark.high) + path(frame, mark, mark.low, true, 'L') + "Z", filled(0.16));
  switch (mark.kind) {
    case Kind::line:
      text += svg::path(path(frame, mark, mark.y), stroke(mark) + R"( stroke-linejoin="round")");
      break;
    case Kind::dots:
      if (mark.size > 0) text += svg::path(dots(frame, mark), stroke(mark) + R"( stroke-linecap="round")");
      break;
    case Kind::diamonds:
      text += svg::path(dots(frame, mark), filled(1));
      break;
    case Kind::stems:
      text += svg::path(stems(frame, mark), stroke(mark));
      break;
    case Kind::shape:
      text +=
          svg::path(path(frame, mark, mark.y) + "Z",
                    filled(mark.opacity) +
                        (mark.size > 0 ? fmt::format(R"(stroke="{}" stroke-width="{}")", mark.colour, mark.size) : ""));
      break;
  }
  // Lines of one name are shown and hidden together, whatever picture they are in.
  return mark.label.empty() ? text : svg::group(fmt::format("data-line=\"{}\"", escape(mark.label)), text);
}

/// One path per colour; runs of equal neighbours in x joined.
std::string drawn(const Frame& frame, const std::vector<ColourMap::Cell>& cells, const ColourScale& scale) {
  std::map<std::string, std::string> paths;
  for (std::size_t i = 0; i < cells.size();) {
    const auto& first = cells[i];
    const auto& colour = scale.of(first.value);
    double end = first.x.high;
    for (++i; i < cells.size() && cells[i].x.low == end && cells[i].y.low == first.y.low &&
              cells[i].y.high == first.y.high && scale.of(cells[i].value) == colour;
         ++i)
      end = cells[i].x.high;
    const Point corner = frame.at(first.x.low, first.y.high), other = frame.at(end, first.y.low);
    paths[colour] +=
        fmt::format("M{0:.1f} {1:.1f}H{2:.1f}V{3:.1f}H{0:.1f}Z", corner.x(), corner.y(), other.x(), other.y());
  }
  std::string text;
  for (const auto& [colour, d] : paths) text += svg::path(d, "fill=\"" + colour + "\"");
  return svg::group(R"(shape-rendering="crispEdges")", text);
}

/// The scale as a bar from bottom to top, with ticks, and the grey of cells without a value below it.
std::string colour_bar(const ColourScale& scale, const Chart& chart, double top) {
  constexpr double width = 12;
  const double left = chart.width - chart.right + 14, right = left + width;
  const Axis across, up{.range = scale.range};
  const Frame bar{left, right, top, chart.height - chart.below - (scale.grey.empty() ? 0 : 26), across, up};
  std::string text;
  const auto& colours = scale.colours;
  const double step = (bar.bottom - top) / static_cast<double>(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double low = bar.bottom - static_cast<double>(i) * step;
    text += svg::rectangle({left, low - step - 0.2}, {right, low + 0.2}, "fill=\"" + colours[i] + "\"");
  }
  for (const auto& [value, label] : ticks_of(up, (bar.bottom - top) / 34))
    text += svg::words({right + 5, bar.at_y(value) + 3.5}, label);
  text += svg::words({chart.width - 2, top - 8}, scale.label, svg::at_the_end);
  if (scale.grey.empty()) return text;
  const auto style = fmt::format(R"(fill="{}" stroke="#aaa" stroke-width="0.5")", scale.of({}));
  return text + svg::rectangle({left, bar.bottom + 13}, {right, bar.bottom + 25}, style) +
         svg::words({right + 5, bar.bottom + 22.5}, scale.grey);
}

constexpr double legend_line = 17;

double title_left(const Chart& chart) { return chart.panels.front().y.names.empty() ? chart.left : 4; }

/// Distance from the top.
double below_title(const Chart& chart) {
  return svg::title_height(svg::title_lines(chart.title, chart.width, title_left(chart)));
}

/// The legend of a chart in rows that end `above` its panels.
struct DrawnLegend {
  std::string text{};
  double height = 0;
};
DrawnLegend legend_of(const Chart& chart) {
  DrawnLegend legend;
  double x = chart.left, y = below_title(chart) + 9;
  if (!chart.legend) return legend;
  for (const auto& mark : chart.panels.front().marks) {
    if (!mark.in_legend) continue;
    const double width = 30 + 6.4 * static_cast<double>(mark.label.size());
    if (x + width > chart.width - chart.right && x > chart.left) {
      x = chart.left;
      y += legend_line;
    }
    Mark sample{.colour = mark.colour, .size = 2.5, .dash = mark.dash};
    legend.text += svg::line({x, y}, {x + 14, y}, stroke(sample)) + svg::words({x + 18, y + 3.5}, mark.label);
    legend.height = y - below_title(chart) + 9;
    x += width;
  }
  return legend;
}

}  // namespace

std::string to_svg(const Chart& chart) {
  constexpr double between = 16, edge = 2;
  const auto legend = legend_of(chart);
  const double top = below_title(chart) + legend.height + (chart.scale ? 14 : 0);
  const auto count = static_cast<double>(chart.panels.size());
  const double width = (chart.width - chart.left - chart.right - between * (count - 1)) / count;
  std::string text = legend.text;
  double left = chart.left;
  for (const auto& panel : chart.panels) {
    const Frame frame{left, left + width, top, chart.height - chart.below, panel.x, panel.y};
    text += axes(frame);
    if (!panel.title.empty()) text += svg::words({left, top - 7}, panel.title);
    if (chart.scale) text += drawn(frame, panel.cells, *chart.scale);
    std::string marks;
    for (const auto& mark : panel.marks) marks += drawn(frame, mark);
    for (const auto& w : panel.words)
      marks += svg::words(frame.at(w.x, w.y) + Point(w.shift, -w.rise), w.text,
                          fmt::format(R"({} fill="{}")", w.shift < 0 ? svg::at_the_end : "", w.colour));
    // A nested <svg> clips what it shows, without an identifier that would have to be unique within the page.
    const Point corner(left - edge, top - edge);
    const bool named = !panel.x.names.empty() || !panel.y.names.empty();
    text += named ? marks
                  : svg::window(corner, Point(frame.right, frame.bottom) - corner + Point(edge, edge), corner, marks);
    left += width + between;
  }
  if (chart.scale) text += colour_bar(*chart.scale, chart, top);
  return svg::titled_picture(chart.title, chart.label, chart.width, chart.height, title_left(chart), text);
}

}  // namespace annulus::app
