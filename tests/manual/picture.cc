#include <algorithm>
#include <cmath>

#include "app/report/plot/chart.h"
#include "page.h"

namespace annulus::manual {

namespace {

/// A little air beside the first and the last dot.
app::Range x_range(const Picture& picture) {
  app::RangeFinder range;
  for (const auto& c : picture.curves)
    for (const double x : c.x) range.add(picture.x_log ? std::log(x) : x);
  const auto [low, high] = range.range(0.03);
  return picture.x_log ? app::Range{std::exp(low), std::exp(high)} : app::Range{low, high};
}

/// At most some forty of them, so that the line can be seen.
app::Series dots_of(const Curve& curve) {
  app::Series dots;
  dots.style = app::Series::Style::dots;
  dots.size = curve.x.size() > 20 ? 4.5 : 6.5;
  const auto step = 1 + curve.x.size() / 45;
  for (std::size_t i = 0; i < curve.x.size(); i += step) {
    dots.x.push_back(curve.x[i]);
    dots.y.push_back(curve.computed[i]);
  }
  return dots;
}

}  // namespace

// Lines are references, dots what was computed; without a reference the computed values are the line.
std::string picture_svg(const Picture& picture) {
  app::Plot plot;
  plot.title = picture.title;
  plot.x_label = picture.x_label;
  plot.y_label = picture.y_label;
  plot.x_log = picture.x_log;
  plot.y_log = picture.y_log;
  plot.x_range = x_range(picture);
  plot.width = 520;
  plot.height = 300;
  plot.legend = true;
  const bool one = picture.curves.size() == 1;
  for (std::size_t i = 0; i < picture.curves.size(); ++i) {
    const auto& c = picture.curves[i];
    const bool compared = !c.reference.empty();
    app::Series line;
    line.colour = i;
    line.x = compared && !c.reference_x.empty() ? c.reference_x : c.x;
    line.y = compared ? c.reference : c.computed;
    line.dashed = compared && picture.slopes;
    line.label = compared && one ? (line.dashed ? "order of theory" : "reference") : c.label;
    plot.series.push_back(line);
    if (!compared) continue;
    auto dots = dots_of(c);
    dots.colour = one ? 1 : i;
    if (one) dots.label = c.label.empty() ? "annulus" : "annulus, " + c.label;
    plot.series.push_back(dots);
  }
  return app::to_svg(plot) + '\n';
}

std::string tolerances_svg(const std::vector<const Record*>& cases) {
  constexpr double lowest = 1e-5, highest = 8;
  app::Plot plot;
  plot.title = "Share of the tolerance that each comparison takes";
  plot.x_label = "quantities, in the order below; a colour per test case";
  plot.y_label = "difference / tolerance";
  plot.y_log = true;
  plot.y_range = app::Range{lowest / 1.5, highest};
  plot.levels.emplace_back(1.0, "tolerance");
  plot.width = 520;
  plot.height = 200;
  double number = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    app::Series dots;
    dots.style = app::Series::Style::dots;
    dots.size = 5;
    dots.colour = i;
    for (const auto& row : cases[i]->rows) {
      dots.x.push_back(++number);
      dots.y.push_back(std::max(row.used, lowest));
    }
    if (!dots.x.empty()) plot.series.push_back(std::move(dots));
  }
  plot.x_range = app::Range{0, number + 1};
  return app::to_svg(plot) + '\n';
}

}  // namespace annulus::manual
