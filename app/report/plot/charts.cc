#include <algorithm>
#include <cmath>

#include "app/report/plot/chart.h"
#include "app/report/plot/colour_scale.h"
#include "app/report/text/svg.h"
#include "core/not_known.h"

/// The kinds of plots as marks.
namespace annulus::app {

namespace {

using Kind = Mark::Kind;

constexpr const char *reference_colour = "#777", *known_colour = "#222222";
constexpr double nothing = not_known;  // lifts the pen

double largest_known(double error) { return error > 0 && std::isfinite(error) ? error : 0; }

Mark mark_of(const Series& s, std::size_t number, const std::string& title) {
  static constexpr Kind kinds[] = {Kind::line, Kind::dots, Kind::stems};  // in the order of Series::Style
  Mark mark{.kind = kinds[static_cast<std::size_t>(s.style)],
            .label = s.label.empty() ? title : s.label,
            .colour = palette(s.colour),
            .x = s.x,
            .y = s.y,
            .group = number,
            .in_legend = !s.label.empty()};
  if (s.low.size() == s.x.size() && s.high.size() == s.x.size()) mark.low = s.low, mark.high = s.high;
  if (s.style == Series::Style::dots) mark.size = s.size;
  if (s.dashed) mark.dash = {5, 3};
  return mark;
}

/// What the series of a plot need upright.
Range y_range(const Plot& plot) {
  RangeFinder y;
  for (const auto& s : plot.series) {
    if (plot.y_log) {
      for (const double v : s.y) y.add(v > 0 ? std::log(v) : nothing);
      continue;
    }
    for (const auto* values : {&s.y, &s.low, &s.high}) y.add(*values);
    if (s.style == Series::Style::bars) y.add(0);
  }
  if (plot.y_log) return {std::exp(y.range().low), std::exp(y.range().high)};
  for (const auto& [value, label] : plot.levels) y.add(value);
  return y.range();
}

/// A rectangle from corner to corner.
Mark rectangle(const std::string& colour, double x1, double x2, double y1, double y2) {
  return {.kind = Kind::shape, .colour = colour, .x = {x1, x2, x2, x1, x1}, .y = {y1, y1, y2, y2, y1}, .size = 0};
}

/// An error bar from `low` to `high` with caps of half a width `cap` to either side of `across`, upright.
Mark whisker(const std::string& colour, double across, double low, double high, double cap) {
  return {.colour = colour,
          .x = {across, across, nothing, across - cap, across + cap, nothing, across - cap, across + cap},
          .y = {low, high, nothing, low, low, nothing, high, high},
          .size = 1.3};
}

}  // namespace

Chart::Chart(const Plot& plot)
    : title(plot.title),
      label(plot.title + (plot.title.empty() ? "" : ": ") + plot.y_label + " over " + plot.x_label),
      width(plot.width),
      height(plot.height),
      legend(plot.legend) {
  RangeFinder x;
  for (const auto& s : plot.series) x.add(s.x);
  const Range across = plot.x_range.value_or(x.range(0));
  Panel panel{.x = {.label = plot.x_label, .range = across, .log = plot.x_log},
              .y = {.label = plot.y_label, .range = plot.y_range.value_or(y_range(plot)), .log = plot.y_log}};
  for (const auto& [value, text] : plot.levels) {
    panel.marks.push_back({.colour = reference_colour,
                           .x = {across.low, across.high},
                           .y = {value, value},
                           .size = 1,
                           .dash = {2, 3},
                           .group = plot.series.size()});
    panel.words.push_back({across.high, value, text, "#666", -3, 4});
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    panel.marks.push_back(mark_of(plot.series[i], i, plot.title.empty() ? plot.y_label : plot.title));
  for (const auto& note : plot.notes) panel.words.push_back({note.x, note.y, note.text, "#666", -3, 3});
  panels = {panel};
}

Chart::Chart(const BarChart& bars)
    : title(bars.title), width(bars.width), left(bars.label_width), right(8), below(bars.x_label.empty() ? 8 : 44) {
  double reach = bars.reach;
  bool negative = bars.two_sided, positive = bars.two_sided, notes = false;
  Panel panel;
  for (const auto& bar : bars.bars) {
    const double known_error = largest_known(bar.error);
    const Range ends = bar.spread.value_or(Range{bar.value - known_error, bar.value + known_error});
    const double nominal = bar.nominal.value_or(bar.value);
    if (!(bars.reach > 0)) reach = std::max({reach, std::abs(ends.low), std::abs(ends.high), std::abs(nominal)});
    negative = negative || bar.value < 0;
    positive = positive || bar.value > 0;
    notes = notes || !bar.note.empty();
    const double middle = static_cast<double>(panel.y.names.size()) + 0.5;
    panel.y.names.push_back(bar.label);
    panel.marks.push_back(rectangle(palette(bar.colour), 0, bar.value, middle - 0.36, middle + 0.36));
    if (ends.high > ends.low) {
      auto line = whisker(known_colour, middle, ends.low, ends.high, 0.2);
      std::swap(line.x, line.y);
      panel.marks.push_back(line);
    }
    if (bar.nominal)
      panel.marks.push_back({.kind = Kind::diamonds,
                             .label = bar.label + ", nominal inputs",
                             .colour = known_colour,
                             .x = {*bar.nominal},
                             .y = {middle},
                             .size = 9,
                             .error = known_error});
    panel.marks.push_back({.kind = Kind::dots,
                           .label = bar.label,
                           .colour = palette(bar.colour),
                           .x = {bar.value},
                           .y = {middle},
                           .size = 0,
                           .error = bar.spread ? 0 : known_error});
    const double side = bar.value < 0 ? -1 : 1;
    if (!bar.note.empty())
      panel.words.push_back({side > 0 ? std::max(ends.high, nominal) : std::min(ends.low, nominal), middle, bar.note,
                             "#333", 4 * side, -4});
  }
  const auto rows = static_cast<double>(bars.bars.size());
  height = svg::title_height(svg::title_lines(title, width, 4)) + bars.row_height * rows + below;
  if (!(reach > 0)) reach = 1;
  positive = positive || !negative;
  const double note_space = notes ? 62 : 8;
  if (negative) left += note_space, panel.y.gap += note_space;
  if (positive) right = note_space;
  panel.x = {.label = bars.x_label, .range = {negative ? -reach : 0, positive ? reach : 0}};
  panel.y.range = {rows, 0};  // the first at the top
  panel.marks.push_back({.colour = "#888", .x = {0, 0}, .y = {0, rows}, .size = 1});
  panels = {panel};
}

Chart::Chart(const SpreadPlot& spread) : title(spread.title), width(spread.width), height(spread.height), below(30) {
  RangeFinder up;
  Panel panel{.y = {.label = spread.y_label}};
  const double columns = std::max<double>(1, static_cast<double>(spread.columns.size()));
  // x counts the columns. By the golden section samples that follow each other do not fall on each other, and the
  // picture is the same every time.
  constexpr double golden = 0.6180339887498949, half = 0.14;
  const double box_half = std::min(0.07, 18 * columns / (width - left - right));
  for (std::size_t i = 0; i < spread.columns.size(); ++i) {
    const auto& c = spread.columns[i];
    up.add(c.values);
    for (const double v : {c.q05, c.q95, c.nominal - c.nominal_error, c.nominal + c.nominal_error}) up.add(v);
    const double middle = static_cast<double>(i) + 0.5, box = middle + 0.08, known = middle + 0.24;
    const std::string colour = palette(c.colour);
    panel.x.names.push_back(c.label);
    Mark samples{.kind = Kind::dots,
                 .label = c.label,
                 .colour = colour,
                 .y = c.values,
                 .size = 3,
                 .opacity = 0.5,
                 .in_legend = true};
    for (std::size_t k = 1; k <= c.values.size(); ++k)
      samples.x.push_back(middle - 0.18 + (2 * std::fmod(golden * static_cast<double>(k), 1.0) - 1) * half);
    auto quartiles = rectangle(colour, box - box_half, box + box_half, c.q25, c.q75);
    quartiles.opacity = 0.25;
    quartiles.size = 1.4;
    const Mark median{.colour = colour, .x = {box - box_half, box + box_half}, .y = {c.median, c.median}, .size = 2.4};
    const auto values_at = [&](const char* what, double at, const std::vector<double>& values) {
      return Mark{.kind = Kind::dots,
                  .label = c.label + what,
                  .colour = colour,
                  .x = std::vector(values.size(), at),
                  .y = values,
                  .size = 0};
    };
    auto as_given = values_at(": as given", known, {c.nominal});
    as_given.kind = Kind::diamonds;
    as_given.size = 10;
    as_given.colour = known_colour;
    as_given.error = c.nominal_error;
    std::vector<Mark> all = {samples,
                             whisker(colour, box, c.q05, c.q25, box_half / 2),
                             whisker(colour, box, c.q75, c.q95, box_half / 2),
                             quartiles,
                             median,
                             values_at(": 5 to 95 %", box, {c.q05, c.q95}),
                             values_at(": quartiles", box, {c.q25, c.q75}),
                             values_at(": median", box, {c.median}),
                             as_given};
    if (largest_known(c.nominal_error) > 0)
      all.push_back(whisker(known_colour, known, c.nominal - c.nominal_error, c.nominal + c.nominal_error, 0.03));
    for (auto& mark : all) {
      mark.group = i;
      panel.marks.push_back(std::move(mark));
    }
  }
  panel.x.range = {0, columns};
  panel.y.range = up.range();
  panels = {panel};
}

Chart::Chart(const ColourMap& map) : title(map.title), width(map.width), height(map.height), right(92) {
  const bool both_ways = map.values.low < 0;
  const double most = std::max(std::abs(map.values.low), std::abs(map.values.high));
  scale = ColourScale{.label = map.value_label,
                      .range = both_ways ? Range{-most, most} : map.values,
                      .colours = scale_colours(both_ways ? Ways::both : Ways::one),
                      .grey = map.grey};
  for (const auto& given : map.panels) {
    Panel panel{.title = given.title,
                .x = {.label = map.x_label, .range = given.x_range},
                .y = {.range = map.y_range, .ticks = 0},
                .cells = given.cells};
    // Only the first panel says what is upright.
    if (panels.empty()) panel.y.label = map.y_label, panel.y.ticks = map.y_ticks;
    Mark line{.colour = "#ffffff", .size = 3, .opacity = 0.7};
    for (const auto& [x, y] : given.line) {
      line.x.push_back(x);
      line.y.push_back(y);
    }
    panel.marks = {line, line};  // with a pale edge
    panel.marks.back().colour = "#111111";
    panel.marks.back().size = 1.2;
    panel.marks.back().opacity = 1;
    panels.push_back(std::move(panel));
  }
}

const std::string& ColourScale::of(const std::optional<double>& value) const {
  static const std::string no_value = "#bcc2c7";
  if (!value || !std::isfinite(*value)) return no_value;
  return colours[colour_level((*value - range.low) / (range.high - range.low))];
}

}  // namespace annulus::app
