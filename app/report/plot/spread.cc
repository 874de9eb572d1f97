#include "app/report/plot/spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/report/plot/frame.h"
#include "app/report/plot/plot_data.h"
#include "app/report/text/xml.h"

namespace annulus::app {

namespace {

std::string sample_dots(const Frame& frame, const SpreadColumn& column, const std::vector<double>& at) {
  std::set<std::string> places;
  for (std::size_t i = 0; i < column.values.size(); ++i)
    if (std::isfinite(column.values[i]))
      places.insert(fmt::format("M{:.1f} {:.1f}h0", frame.at_x(at[i]), frame.at_y(column.values[i])));
  std::string d;
  for (const auto& place : places) d += place;
  return fmt::format(
      "<path d=\"{}\" stroke=\"{}\" stroke-width=\"3\" stroke-linecap=\"round\" stroke-opacity=\"0.5\"/>", d,
      palette(column.colour));
}

std::string box(const Frame& frame, const SpreadColumn& c, double x, double half) {
  const char* colour = palette(c.colour);
  const double y05 = frame.at_y(c.q05), y25 = frame.at_y(c.q25), y50 = frame.at_y(c.median), y75 = frame.at_y(c.q75),
               y95 = frame.at_y(c.q95);
  std::string svg = fmt::format(
      "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{0:.1f} {3:.1f}V{4:.1f}M{5:.1f} {1:.1f}h{6:.1f}M{5:.1f} {4:.1f}h{6:.1f}\" "
      "stroke=\"{7}\" stroke-width=\"1.6\" fill=\"none\"/>",
      x, y05, y25, y75, y95, x - half / 2, half, colour);
  svg += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" fill-opacity=\"0.25\" "
      "stroke=\"{}\" stroke-width=\"1.4\"/>",
      x - half, y75, 2 * half, std::max(0.0, y25 - y75), colour, colour);
  return svg + fmt::format("<path d=\"M{:.1f} {:.1f}h{:.1f}\" stroke=\"{}\" stroke-width=\"2.4\"/>", x - half, y50,
                           2 * half, colour);
}

std::string nominal_mark(const Frame& frame, const SpreadColumn& c, double x) {
  if (!std::isfinite(c.nominal)) return "";
  const double y = frame.at_y(c.nominal);
  std::string svg = fmt::format("<path d=\"M{:.1f} {:.1f}l5 -5l5 5l-5 5z\" fill=\"#222\"/>", x - 5, y);
  if (!std::isfinite(c.nominal_error) || !(c.nominal_error > 0)) return svg;
  const double low = frame.at_y(c.nominal - c.nominal_error), high = frame.at_y(c.nominal + c.nominal_error);
  return svg + fmt::format(
                   "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h8M{3:.1f} {2:.1f}h8\" stroke=\"#222\" "
                   "stroke-width=\"1.3\" fill=\"none\"/>",
                   x, low, high, x - 4);
}

}  // namespace

ColumnPlaces places_in_column(std::size_t index, std::size_t samples) {
  // By the golden section: the picture is the same every time.
  constexpr double golden = 0.6180339887498949, half = 0.14;
  const double middle = static_cast<double>(index) + 0.5;
  ColumnPlaces places{.samples = {}, .box = middle + 0.08, .nominal = middle + 0.24};
  for (std::size_t i = 0; i < samples; ++i)
    places.samples.push_back(middle - 0.18 + (2 * std::fmod(golden * static_cast<double>(i + 1), 1.0) - 1) * half);
  return places;
}

std::string to_svg(const SpreadPlot& plot) {
  RangeFinder y;
  for (const auto& c : plot.columns) {
    y.add(c.values);
    y.add(c.q05);
    y.add(c.q95);
    y.add(c.nominal + c.nominal_error);
    y.add(c.nominal - c.nominal_error);
  }
  const double columns = std::max<double>(1, static_cast<double>(plot.columns.size()));
  // x counts the columns; their labels stand in place of its ticks.
  const Frame frame{
      62, plot.width - 12.0, plot.title.empty() ? 10.0 : 26.0, plot.height - 30.0, {0, columns}, y.range(), false};
  std::string svg = open_svg(plot.title, plot.width, plot.height, frame.left);
  svg += y_axis(frame, plot.y_label);
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const auto& c = plot.columns[i];
    const double middle = frame.at_x(static_cast<double>(i) + 0.5), unit = (frame.right - frame.left) / columns;
    const auto places = places_in_column(i, c.values.size());
    svg += "<g><title>" + escape(c.label) + "</title>" + sample_dots(frame, c, places.samples) +
           box(frame, c, frame.at_x(places.box), std::min(0.07 * unit, 18.0)) +
           nominal_mark(frame, c, frame.at_x(places.nominal)) + "</g>";
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"12\">{}</text>", middle,
                       frame.bottom + 18, escape(c.label));
  }
  return svg + "</svg>";
}

nlohmann::json plot_data(const SpreadPlot& plot) {
  nlohmann::json data = {{"kind", "curves"},
                         {"title", plot.title},
                         {"x_label", ""},
                         {"y_label", plot.y_label},
                         {"x_log", false},
                         {"y_log", false},
                         {"x_range", {0, plot.columns.size()}},
                         {"series", nlohmann::json::array()},
                         {"levels", nlohmann::json::array()},
                         {"names", nlohmann::json::array()}};
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const auto& c = plot.columns[i];
    const auto places = places_in_column(i, c.values.size());
    data["names"].push_back(c.label);
    const auto add = [&](const char* what, const char* style, const std::vector<double>& x,
                         const std::vector<double>& y) -> nlohmann::json& {
      data["series"].push_back({{"label", c.label + what},
                                {"colour", palette(c.colour)},
                                {"style", style},
                                {"dashed", false},
                                {"size", 4},
                                {"group", i},
                                {"x", plot_numbers(x)},
                                {"y", plot_numbers(y)}});
      return data["series"].back();
    };
    add("", "dots", places.samples, c.values)["fade"] = "80";
    add(": 5 to 95 %", "line", {places.box, places.box}, {c.q05, c.q95})["unnamed"] = true;
    auto& quartiles = add(": quartiles", "line", {places.box, places.box}, {c.q25, c.q75});
    quartiles["unnamed"] = true;
    quartiles["width"] = 16;
    quartiles["fade"] = "60";
    auto& median = add(": median", "dots", {places.box}, {c.median});
    median["unnamed"] = true;
    median["size"] = 9;
    auto& nominal = add(": as given", "dots", {places.nominal, places.nominal, places.nominal},
                        {c.nominal - c.nominal_error, c.nominal, c.nominal + c.nominal_error});
    nominal["unnamed"] = true;
    nominal["joined"] = true;
    nominal["colour"] = "#222222";
  }
  return data;
}

}  // namespace annulus::app
