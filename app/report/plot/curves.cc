#include "app/report/plot/curves.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/report/plot/frame.h"
#include "app/report/plot/plot_data.h"
#include "app/report/text/xml.h"

namespace annulus::app {

namespace {

/// Points of a long ascending series, reduced to the first, smallest, largest and last of every part; all points of a
/// short one. `end_of`: index behind the part that begins at an index.
template <class End>
std::vector<std::size_t> reduced_points(const std::vector<double>& x, const std::vector<double>& y, std::size_t parts,
                                        End end_of) {
  std::vector<std::size_t> points;
  if (x.size() <= 4 * parts || !std::is_sorted(x.begin(), x.end())) {
    for (std::size_t i = 0; i < x.size(); ++i) points.push_back(i);
    return points;
  }
  for (std::size_t begin = 0, end = 0; begin < x.size(); begin = end) {
    end = end_of(begin);
    std::size_t low = begin, high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (y[i] < y[low]) low = i;
      if (y[i] > y[high]) high = i;
    }
    for (const std::size_t i : std::set<std::size_t>{begin, low, high, end - 1}) points.push_back(i);
  }
  return points;
}

/// The points that a picture needs: parts are columns of pixels.
std::vector<std::size_t> visible_points(const Frame& frame, const std::vector<double>& x,
                                        const std::vector<double>& y) {
  return reduced_points(x, y, static_cast<std::size_t>(frame.right - frame.left), [&](std::size_t begin) {
    const double column = std::floor(frame.at_x(x[begin]));
    std::size_t end = begin + 1;
    while (end < x.size() && std::floor(frame.at_x(x[end])) == column) ++end;
    return end;
  });
}

/// Distinct dots: of several thousand, one in each cell of a fine grid over them.
std::vector<std::size_t> distinct_dots(const Series& s) {
  constexpr std::size_t few = 4000;
  constexpr double columns = 600, rows = 400;
  std::vector<std::size_t> points;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
    points.push_back(i);
    box.extend(Eigen::Vector2d(s.x[i], s.y[i]));
  }
  if (points.size() <= few) return points;
  const auto cell = [](double value, double low, double size, double cells) {
    return size > 0 ? std::lround(cells * (value - low) / size) : 0;
  };
  std::set<std::pair<long, long>> taken;
  std::erase_if(points, [&](std::size_t i) {
    return !taken
                .emplace(cell(s.x[i], box.min().x(), box.sizes().x(), columns),
                         cell(s.y[i], box.min().y(), box.sizes().y(), rows))
                .second;
  });
  return points;
}

/// The points that page.js gets: parts are equal numbers of points.
std::vector<std::size_t> points_for_zoom(const Series& s) {
  if (s.style == Series::Style::dots) return distinct_dots(s);
  constexpr std::size_t steps = 1000;
  std::size_t step = 0;
  return reduced_points(s.x, s.y, steps, [&](std::size_t) { return ++step * s.x.size() / steps; });
}

std::string path(const Frame& frame, const std::vector<double>& x, const std::vector<double>& y) {
  std::string d;
  bool pen_down = false;
  for (const std::size_t i : visible_points(frame, x, y)) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      pen_down = false;
      continue;
    }
    d += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", frame.at_x(x[i]), frame.at_y(y[i]));
    pen_down = true;
  }
  return d;
}

std::string band(const Frame& frame, const Series& s) {
  std::vector<double> x = s.x, y = s.high;
  std::string points;
  for (const std::size_t i : visible_points(frame, s.x, s.high))
    points += fmt::format("{:.1f},{:.1f} ", frame.at_x(s.x[i]), frame.at_y(s.high[i]));
  auto lower = visible_points(frame, s.x, s.low);
  for (auto i = lower.rbegin(); i != lower.rend(); ++i)
    points += fmt::format("{:.1f},{:.1f} ", frame.at_x(s.x[*i]), frame.at_y(s.low[*i]));
  return fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.16\" stroke=\"none\"/>", points,
                     palette(s.colour));
}

std::string draw(const Frame& frame, const Series& s) {
  std::string svg = "<g><title>" + escape(s.label) + "</title>";
  const char* colour = palette(s.colour);
  if (!s.low.empty() && s.low.size() == s.x.size() && s.high.size() == s.x.size()) svg += band(frame, s);
  switch (s.style) {
    case Series::Style::line:
      svg +=
          fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"{}/>",
                      path(frame, s.x, s.y), colour, s.dashed ? " stroke-dasharray=\"5 3\"" : "");
      break;
    case Series::Style::dots: {
      // Lines of no length with round ends; points that fall on the same place of the page are drawn once.
      std::set<std::string> places;
      for (const std::size_t i : distinct_dots(s))
        places.insert(fmt::format("M{:.1f} {:.1f}h0", frame.at_x(s.x[i]), frame.at_y(s.y[i])));
      std::string d;
      for (const auto& place : places) d += place;
      svg +=
          fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"/>", d, colour, s.size);
      break;
    }
    case Series::Style::bars: {
      std::string d;
      const double base = std::clamp(frame.at_y(0), frame.top, frame.bottom);
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        const double top = frame.at_y(s.y[i]);
        // A line no higher than half a pixel would only make the file larger.
        if (std::isfinite(top) && std::abs(top - base) > 0.5)
          d += fmt::format("M{:.1f} {:.1f}V{:.1f}", frame.at_x(s.x[i]), base, top);
      }
      svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>", d, colour);
      break;
    }
  }
  return svg + "</g>";
}

constexpr double legend_line = 17;

/// Legend entries in rows: x of each labelled series, and its row.
struct LegendPlace {
  const Series* series;
  double x;
  int row;
};
std::vector<LegendPlace> legend_places(const Plot& plot, double left, double right) {
  std::vector<LegendPlace> places;
  double x = left;
  int row = 0;
  for (const auto& s : plot.series) {
    if (s.label.empty() || !plot.legend) continue;
    const double width = 30 + 6.4 * static_cast<double>(s.label.size());
    if (x + width > right && x > left) {
      x = left;
      ++row;
    }
    places.push_back({&s, x, row});
    x += width;
  }
  return places;
}

std::string legend(const Frame& frame, const Plot& plot) {
  std::string svg;
  const auto places = legend_places(plot, frame.left, frame.right);
  for (const auto& [s, x, row] : places) {
    const double y = frame.top - 9 - legend_line * (places.back().row - row);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}h14\" stroke=\"{}\" stroke-width=\"2.5\"{}/>", x, y, palette(s->colour),
                       s->dashed ? " stroke-dasharray=\"5 3\"" : "");
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x + 18, y + 3.5, escape(s->label));
  }
  return svg;
}

Frame frame_of(const Plot& plot) {
  RangeFinder x, y;
  for (const auto& s : plot.series) {
    x.add(s.x);
    y.add(s.y);
    y.add(s.low);
    y.add(s.high);
    if (s.style == Series::Style::bars) y.add(0);
  }
  for (const auto& [value, label] : plot.levels) y.add(value);
  Range up = plot.y_range.value_or(y.range());
  if (plot.y_log && !plot.y_range) {
    RangeFinder positive;
    for (const auto& s : plot.series) {
      for (const double v : s.y) positive.add(v > 0 ? std::log(v) : std::nan(""));
    }
    const Range logs = positive.range();
    up = {std::exp(logs.low), std::exp(logs.high)};
  }
  constexpr double left = 62, right_margin = 12;
  const auto places = legend_places(plot, left, plot.width - right_margin);
  const double top = (plot.title.empty() ? 10 : 26) + (places.empty() ? 0 : 1 + legend_line * (places.back().row + 1));
  return {
      left,      plot.width - right_margin, top, plot.height - 42.0, plot.x_range.value_or(x.range(0)), up, plot.x_log,
      plot.y_log};
}

}  // namespace

std::string to_svg(const Plot& plot) {
  const Frame frame = frame_of(plot);
  std::string svg = open_svg(plot.title, plot.width, plot.height, frame.left,
                             plot.title + (plot.title.empty() ? "" : ": ") + plot.y_label + " over " + plot.x_label);
  svg += axes(frame, plot.x_label, plot.y_label);
  if (plot.legend) svg += legend(frame, plot);
  // A nested <svg> clips what it shows, without an identifier that would have to be unique within the page.
  const double left = frame.left - 2, top = frame.top - 2, w = frame.right - frame.left + 4,
               h = frame.bottom - frame.top + 4;
  svg += fmt::format(
      "<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" viewBox=\"{0:.1f} {1:.1f} {2:.1f} "
      "{3:.1f}\">",
      left, top, w, h);
  for (const auto& [value, label] : plot.levels) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#777\" stroke-dasharray=\"2 3\"/>", frame.left,
                       frame.at_y(value), frame.right);
    if (!label.empty())
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"#666\">{}</text>", frame.right - 3,
                         frame.at_y(value) - 4, escape(label));
  }
  for (const auto& s : plot.series) svg += draw(frame, s);
  for (const auto& note : plot.notes)
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"#666\">{}</text>",
                       frame.at_x(note.x) - 3, frame.at_y(note.y) - 3, escape(note.text));
  return svg + "</svg></svg>";
}

namespace {

nlohmann::json numbers(const std::vector<double>& values, const std::vector<std::size_t>& points) {
  auto list = nlohmann::json::array();
  for (const std::size_t i : points) list.push_back(plot_number(values[i]));
  return list;
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

nlohmann::json plot_data(const Plot& plot) {
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
    const auto points = points_for_zoom(s);
    nlohmann::json series = {
        {"label", s.label}, {"colour", palette(s.colour)}, {"style", style_name(s.style)}, {"dashed", s.dashed},
        {"size", s.size},   {"x", numbers(s.x, points)},   {"y", numbers(s.y, points)}};
    if (!s.low.empty() && s.low.size() == s.x.size() && s.high.size() == s.x.size()) {
      series["low"] = numbers(s.low, points);
      series["high"] = numbers(s.high, points);
    }
    data["series"].push_back(std::move(series));
  }
  for (const auto& [value, label] : plot.levels) data["levels"].push_back({{"value", value}, {"label", label}});
  return data;
}

}  // namespace annulus::app
