#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/overrides.h"
#include "app/report_parts.h"

namespace annulus::app {

namespace {

std::size_t column_of(const std::string& figure) {
  const auto columns = figure_columns(true);
  return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), figure) - columns.begin());
}

std::vector<double> figure_over(const std::vector<StudyPoint>& points, const std::string& figure) {
  const auto column = column_of(figure);
  std::vector<double> values;
  values.reserve(points.size());
  for (const auto& point : points) values.push_back(figure_row(point, true)[column]);
  return values;
}

std::string input_label(const SweepResult& sweep) {
  return sweep.sweep.input + (sweep.unit.empty() ? "" : ", " + sweep.unit);
}

std::vector<std::pair<std::string, std::size_t>> ring_legend(const RunResult& result) {
  std::vector<std::pair<std::string, std::size_t>> entries;
  for (std::size_t i = 0; i < result.rings.size(); ++i) entries.emplace_back(result.rings[i].name, i);
  return entries;
}

/// The values in rising order; sweeps may be given in any.
std::vector<std::size_t> rising(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

std::vector<double> reordered(const std::vector<double>& values, const std::vector<std::size_t>& order) {
  std::vector<double> list;
  list.reserve(order.size());
  for (const std::size_t i : order) list.push_back(values[i]);
  return list;
}

struct SweepFigure {
  const char* title;
  const char* column;
  const char* y_label;
  double scale = 1;
  const char* dashed = nullptr;  ///< a second column
};

/// All rings in one picture; empty when the figure is nowhere known or zero throughout.
std::string sweep_plot(const RunResult& result, const SweepResult& sweep, const SweepFigure& figure) {
  const auto order = rising(sweep.values);
  Plot plot{.title = figure.title, .x_label = input_label(sweep), .y_label = figure.y_label};
  plot.x_log = sweep.sweep.scale == SweepScale::logarithmic;
  bool any = false;
  for (std::size_t ring = 0; ring < result.rings.size(); ++ring) {
    for (const char* column : {figure.column, figure.dashed}) {
      if (!column) continue;
      auto y = reordered(figure_over(sweep.rings[ring], column), order);
      for (auto& v : y) {
        v *= figure.scale;
        any = any || (std::isfinite(v) && v != 0);
      }
      plot.series.push_back({.label = result.rings[ring].name,
                             .x = reordered(sweep.values, order),
                             .y = y,
                             .colour = ring,
                             .dashed = column == figure.dashed});
      plot.series.push_back({.label = result.rings[ring].name,
                             .x = plot.series.back().x,
                             .y = y,
                             .colour = ring,
                             .style = Series::Style::dots,
                             .size = 3.5});
    }
  }
  return any ? to_svg(plot) : "";
}

/// The lowest natural frequencies, one picture per ring; nothing when the input does not move them.
std::vector<std::string> frequency_plots(const RunResult& result, const SweepResult& sweep) {
  const auto order = rising(sweep.values);
  std::vector<std::string> pictures;
  bool moved = false;
  for (std::size_t ring = 0; ring < result.rings.size(); ++ring) {
    Plot plot{.title = result.rings[ring].name + ": natural frequencies",
              .x_label = input_label(sweep),
              .y_label = "frequency, Hz"};
    if (result.rings.size() == 1) plot.width = 2 * plot.width;  // alone in its row
    plot.x_log = sweep.sweep.scale == SweepScale::logarithmic;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto y = reordered(figure_over(sweep.rings[ring], fmt::format("frequency_{}_Hz", i + 1)), order);
      for (const double f : y) moved = moved || std::abs(f - y.front()) > 1e-3 * y.front();
      plot.series.push_back({.label = fmt::format("{}", i + 1),
                             .x = reordered(sweep.values, order),
                             .y = y,
                             .colour = ring,
                             .style = Series::Style::line});
    }
    pictures.push_back(to_svg(plot));
  }
  return moved ? pictures : std::vector<std::string>{};
}

std::vector<std::string> bifurcation_plots(const RunResult& result, const SweepResult& sweep) {
  std::vector<Plot> plots;
  RangeFinder range;
  for (std::size_t ring = 0; ring < result.rings.size(); ++ring) {
    Series series{.label = result.rings[ring].name, .colour = ring, .style = Series::Style::dots, .size = 1.8};
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      for (const auto& p : sweep.rings[ring][i].figures.poincare) {
        series.x.push_back(sweep.values[i]);
        series.y.push_back(p.force / 1e3);
      }
    }
    range.add(series.y);
    Plot plot{.title = result.rings[ring].name, .x_label = input_label(sweep), .y_label = "force, kN"};
    if (result.rings.size() == 1) plot.width = 2 * plot.width;  // alone in its row
    plot.x_log = sweep.sweep.scale == SweepScale::logarithmic;
    plot.series.push_back(std::move(series));
    plots.push_back(std::move(plot));
  }
  std::vector<std::string> pictures;
  for (auto& plot : plots) {
    plot.y_range = range.range();
    pictures.push_back(to_svg(plot));
  }
  return pictures;
}

std::string remarks_of(const RunResult& result, const SweepResult& sweep) {
  std::string text;
  int failed = 0, not_steady = 0;
  std::string first;
  for (std::size_t ring = 0; ring < result.rings.size(); ++ring) {
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      const auto& point = sweep.rings[ring][i];
      if (point.failure.empty()) {
        not_steady += point.figures.steady ? 0 : 1;
      } else if (failed++ == 0) {
        first = fmt::format("{} at {}: {}", result.rings[ring].name, to_text(sweep.values[i], 6), point.failure);
      }
    }
  }
  if (failed) text += fmt::format(" {} responses failed and are left out, the first: {}.", failed, escape(first));
  if (not_steady)
    text += fmt::format(" {} of {} responses did not become periodic; their figures hold for the window only.",
                        not_steady, sweep.values.size() * result.rings.size());
  if (sweep.tables) text += fmt::format(" {} of the values have stiffness tables of their own.", sweep.tables);
  return text;
}

std::string one_sweep(const RunResult& result, std::size_t n) {
  const auto& sweep = result.studies.sweeps[n];
  const auto* parameter = find_input(result.scene, sweep.sweep.input).parameter;
  std::string text = fmt::format(
      "<h3>{}</h3>\n<p>{} {} values; all else as in the scene. Table: "
      "<code>dynamics/sweep_{}.csv</code> of each ring.{}</p>\n",
      escape(sweep.sweep.input), escape(parameter->meaning), sweep.values.size(), n + 1, remarks_of(result, sweep));
  std::vector<std::string> pictures;
  for (const SweepFigure& figure :
       {SweepFigure{"Load sharing of the sun meshes", "sun_planet_load_sharing_averaged", "N F / ΣF", 1,
                    "sun_planet_load_sharing_quasi_static"},
        SweepFigure{"Load sharing of the ring meshes", "ring_planet_load_sharing_averaged", "N F / ΣF", 1,
                    "ring_planet_load_sharing_quasi_static"},
        SweepFigure{"Dynamic factor of the sun meshes", "sun_planet_dynamic_factor", "largest F / mean mesh force"},
        SweepFigure{"Dynamic factor of the ring meshes", "ring_planet_dynamic_factor", "largest F / mean mesh force"},
        SweepFigure{"Time without contact, sun meshes", "sun_planet_contact_loss", "worst planet, %", 100},
        SweepFigure{"Time without contact, ring meshes", "ring_planet_contact_loss", "worst planet, %", 100},
        SweepFigure{"Motion of the sun", "sun_rms_m", "rms, µm", 1e6},
        SweepFigure{"Deflection of the ring mesh", "ring_planet_deflection_peak_to_peak_m", "peak to peak, µm", 1e6}}) {
    auto picture = sweep_plot(result, sweep, figure);
    if (!picture.empty()) pictures.push_back(std::move(picture));
  }
  text += figure(pictures, legend_html(ring_legend(result)),
                 "Largest over the planets. Load sharing: averaged over a mesh cycle, dashed quasi-static.");
  if (const auto frequencies = frequency_plots(result, sweep); !frequencies.empty())
    text += figure(frequencies, "", "The lowest natural frequencies, tangent stiffness, without rotation.");
  return text + figure(bifurcation_plots(result, sweep), "",
                       "Force in planet 1's sun mesh, once per mesh cycle (Poincaré points): errors spread the points "
                       "over one error period; without errors a single point is a motion that repeats with the mesh, "
                       "several points one that repeats after as many cycles, a cloud a chaotic one.");
}

/// Values of one figure: divided, nominal, multiplied.
std::string three(const SensitivityResult& s, const SensitivityRow& row, std::size_t ring,
                  double dynamics::KindFigures::*figure) {
  std::string text;
  for (const auto* point : {&row.divided[ring], &s.nominal[ring], &row.multiplied[ring]}) {
    text += text.empty() ? "" : " / ";
    text += point->failure.empty() ? fmt::format("{:.4f}", point->figures.sun_planet.*figure) : std::string("failed");
  }
  return text;
}

}  // namespace

std::string sweeps_section(const RunResult& result) {
  if (result.studies.sweeps.empty()) return "";
  std::string text = "<h2 id=\"sweeps\">Sweeps</h2>\n";
  for (std::size_t n = 0; n < result.studies.sweeps.size(); ++n) text += one_sweep(result, n);
  return text;
}

std::string sensitivity_section(const RunResult& result) {
  if (!result.studies.sensitivity) return "";
  const auto& s = *result.studies.sensitivity;
  const bool compare = result.rings.size() > 1;
  HtmlTable table{.head = {"input", "value"}, .rows = {}, .css_class = "numbers"};
  for (const auto& ring : result.rings) table.head.push_back("load sharing, " + escape(ring.name));
  for (const auto& ring : result.rings) table.head.push_back("dynamic factor, " + escape(ring.name));
  if (compare) table.head.emplace_back("order of the rings");
  std::size_t kept = 0;
  for (const auto& row : s.rows) {
    std::string value;
    for (const double v : row.values) {
      const std::string text = std::isfinite(v) ? to_text(v, 5) : "–";
      if (value.empty()) {
        value = text;
      } else if (value != text) {
        value += ", " + text;
      }
    }
    std::vector<std::string> cells = {"<code>" + escape(row.input) + "</code>", value + " " + row.unit};
    for (std::size_t i = 0; i < result.rings.size(); ++i)
      cells.push_back(three(s, row, i, &dynamics::KindFigures::averaged));
    for (std::size_t i = 0; i < result.rings.size(); ++i)
      cells.push_back(three(s, row, i, &dynamics::KindFigures::dynamic_factor));
    if (compare)
      cells.emplace_back(row.order_stays ? "<span class=\"tag agrees\">stays</span>"
                                         : "<span class=\"tag disagrees\">changes</span>");
    kept += row.order_stays ? 1 : 0;
    table.rows.push_back(std::move(cells));
  }
  std::string text = fmt::format(
      "<h2 id=\"sensitivity\">Sensitivity</h2>\n<p>Each input divided by {0}, as it is, and multiplied by {0}, one at "
      "a "
      "time. Load sharing of the sun meshes, averaged over a mesh cycle; largest dynamic factor of the sun meshes.",
      to_text(s.factor));
  if (compare)
    text += fmt::format(" The order of the rings by load sharing stays for {} of {} inputs.", kept, s.rows.size());
  return text + "</p>\n" + html(table);
}

}  // namespace annulus::app
