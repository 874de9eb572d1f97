#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"

namespace annulus::app {

std::vector<const RingResult*> rings_with_response(const RunResult& result) {
  std::vector<const RingResult*> list;
  for (const auto& ring : result.rings) {
    if (ring.response) list.push_back(&ring);
  }
  return list;
}

std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to) {
  const auto column = csv.column(name);
  std::vector<double> list;
  for (const auto& row : csv.rows) {
    if (row[0] < rows_to) list.push_back(row[column]);
  }
  return list;
}

std::string planet_legend(int planets) {
  std::vector<std::pair<std::string, std::size_t>> entries;
  entries.reserve(static_cast<std::size_t>(planets));
  for (int n = 0; n < planets; ++n) entries.emplace_back(fmt::format("planet {}", n + 1), static_cast<std::size_t>(n));
  return legend_html(entries);
}

namespace {

std::string branch(const char* mesh, int planet) { return fmt::format("{}{}", mesh, planet + 1); }

/// One plot per ring on one scale, with one line per planet read from `table` of the response.
struct Lines {
  const Csv StageResponse::*table;
  std::string line, low, high;  ///< suffixes of the columns; empty: none
  double cycles = shown_cycles;
};

std::string per_planet(const RunResult& result, const char* mesh, const Lines& lines, const char* y_label,
                       const std::string& caption) {
  const int planets = result.scene.stage.planets;
  std::vector<Plot> plots;
  RangeFinder range;
  range.add(1);
  for (const auto* ring : rings_with_response(result)) {
    const Csv& csv = (*ring->response).*(lines.table);
    Plot plot{.title = ring->name,
              .x_label = "mesh cycle of the evaluated window",
              .y_label = y_label,
              .levels = {{1.0, ""}}};
    for (int n = 0; n < planets; ++n) {
      const auto name = branch(mesh, n);
      Series series{.label = fmt::format("planet {}", n + 1),
                    .x = column_values(csv, "mesh_cycle", lines.cycles),
                    .y = column_values(csv, name + lines.line, lines.cycles),
                    .colour = static_cast<std::size_t>(n)};
      if (!lines.low.empty()) {
        series.low = column_values(csv, name + lines.low, lines.cycles);
        series.high = column_values(csv, name + lines.high, lines.cycles);
      }
      range.add(series.y);
      range.add(series.low);
      range.add(series.high);
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  }
  std::vector<std::string> pictures;
  for (auto& plot : plots) {
    plot.y_range = range.range();
    pictures.push_back(plot_html(plot));
  }
  return figure(pictures, planet_legend(planets), caption);
}

dynamics::Spectrum spectrum_of(const RingResult& ring, const std::string& branch) {
  const auto order = column_values(ring.response->spectrum, "mesh_order");
  const auto amplitude = column_values(ring.response->spectrum, branch + "_N");
  const auto size = static_cast<Eigen::Index>(order.size());
  return {Eigen::Map<const Eigen::VectorXd>(order.data(), size),
          Eigen::Map<const Eigen::VectorXd>(amplitude.data(), size)};
}

/// "1 − 0.018": an order read as a sideband.
std::string order_text(const dynamics::SpectralLine& line) {
  if (std::abs(line.sideband) < 1e-9) return fmt::format("{}", line.harmonic);
  auto distance = fmt::format("{:.3g}", std::abs(line.sideband));
  if (line.harmonic == 0) return distance;
  return fmt::format("{} {} {}", line.harmonic, line.sideband < 0 ? "−" : "+", distance);
}

std::string spectra(const RunResult& result, const char* mesh) {
  constexpr int listed = 4;
  std::vector<Plot> plots;
  HtmlTable table{.head = {"highest lines"}, .rows = {}, .css_class = "numbers"};
  for (int i = 0; i < listed; ++i) table.rows.push_back({fmt::format("{}", i + 1)});
  double highest = 0;
  for (const auto* ring : rings_with_response(result)) {
    const auto spectrum = spectrum_of(*ring, branch(mesh, 0));
    const auto lines = dynamics::highest_lines(spectrum, listed);
    table.head.push_back(escape(ring->name));
    for (std::size_t i = 0; i < listed; ++i)
      table.rows[i].push_back(i < lines.size() ? fmt::format("{:.2f} kN <span class=\"muted\">at {}</span>",
                                                             lines[i].amplitude / 1e3, order_text(lines[i]))
                                               : "");
    if (spectrum.order.size() < 2) continue;
    const Eigen::VectorXd kilonewton =
        spectrum.amplitude.tail(spectrum.amplitude.size() - 1) / 1e3;  // without the mean
    const auto order = spectrum.order.tail(kilonewton.size());
    highest = std::max(highest, kilonewton.maxCoeff());
    plots.push_back({.title = ring->name,
                     .x_label = "order, multiples of the mesh frequency",
                     .y_label = "amplitude, kN",
                     .series = {{.label = "planet 1",
                                 .x = {order.begin(), order.end()},
                                 .y = {kilonewton.begin(), kilonewton.end()},
                                 .colour = 0,
                                 .style = Series::Style::bars}}});
  }
  std::vector<std::string> pictures;
  for (auto& plot : plots) {
    plot.y_range = Range{0, 1.08 * highest};
    plot.x_range = Range{0, plot.series.front().x.back()};
    pictures.push_back(plot_html(plot));
  }
  return figure(
             pictures, "",
             fmt::format("Force of planet 1 without its mean. Order 1 is the mesh frequency, {:.1f} Hz; lines beside "
                         "whole orders are sidebands of the errors.",
                         result.geometry.operating_point.mesh_frequency)) +
         html(table);
}

std::string part_text(double part) { return std::isfinite(part) ? fmt::format("{:.2g}", part) : "not known"; }

struct NamedFigure {
  const char* name;
  const Figure& figure;
  const ErrorParts& errors;
};

std::vector<NamedFigure> explained_figures(const StageResponse& response) {
  const auto& sharing = response.figures.sun_planet.load_sharing;
  const auto& e = response.errors.sun_planet;
  std::vector<NamedFigure> list = {{"load sharing, averaged over a mesh cycle", sharing.averaged, e.averaged},
                                   {"load sharing, instantaneous", sharing.instantaneous, e.instantaneous},
                                   {"load sharing, quasi-static", sharing.quasi_static, e.quasi_static}};
  const auto& branches = response.figures.sun_planet.branches;
  const auto largest = std::max_element(branches.begin(), branches.end(), [](const auto& a, const auto& b) {
    return a.dynamic_factor_max.value < b.dynamic_factor_max.value;
  });
  if (largest != branches.end())
    list.push_back({"largest dynamic factor", largest->dynamic_factor_max,
                    e.dynamic_factor_max[static_cast<std::size_t>(largest - branches.begin())]});
  return list;
}

std::string error_bars(const RunResult& result) {
  HtmlTable table{.head = {"sun meshes", "value ± error", "discretisation", "local contact", "condensation",
                           "table interpolation", "time integration", "model choice"},
                  .rows = {},
                  .css_class = "numbers"};
  for (const auto* ring : rings_with_response(result)) {
    table.rows.push_back({escape(ring->name)});
    for (const auto& [name, f, e] : explained_figures(*ring->response))
      table.rows.push_back({name, measured(f.value, f.error), part_text(e.discretisation), part_text(e.contact),
                            part_text(e.condensation), part_text(e.interpolation), part_text(e.integration),
                            part_text(e.model)});
  }
  return "<h3 id=\"error-bars\">What the error bars contain</h3>\n" + html(table) +
         "<p>Discretisation, local contact, condensation and model choice: the larger change when all stiffnesses of a "
         "mesh, or their ripple, are raised by their error estimate, divided as that estimate is; sun mesh plus ring "
         "mesh. Table interpolation: half of the change with every second position of the tables. Time integration: "
         "sampling, steady state and integrator. The error is their sum, and not known when a part is not; stiffness "
         "given as a wave counts as exact.</p>\n";
}

}  // namespace

std::string dynamics_section(const RunResult& result) {
  if (rings_with_response(result).empty())
    return "<h2 id=\"dynamics\">Load sharing and dynamic factors</h2>\n<p>Not asked for.</p>\n";
  std::string text = "<h2 id=\"dynamics\">Load sharing and dynamic factors</h2>\n";
  const Lines sharing{&StageResponse::load_sharing, "_averaged", "", ""};
  const Lines factor{&StageResponse::dynamic_factor, "_max", "_min", "_max"};
  const Lines waveform{&StageResponse::waveform, "", "", "", 6};
  const Lines sharing_waveform{&StageResponse::sharing_waveform, "", "", "", 6};
  const char* first_cycles = "The first six mesh cycles of the window, at full resolution.";
  const std::string cut =
      fmt::format(" Windows longer than {:.0f} mesh cycles are cut here; the files hold them whole.", shown_cycles);
  text +=
      "<h3>Load sharing of the sun meshes</h3>\n" +
      per_planet(
          result, sun_planet, sharing, "N F / ΣF",
          "Each planet's part of the power, forces averaged over a mesh cycle. The coefficient is the highest point." +
              cut);
  text += per_planet(result, sun_planet, sharing_waveform, "N F / ΣF", first_cycles);
  text += "<h3>Load sharing of the ring meshes</h3>\n" +
          per_planet(result, ring_planet, sharing, "N F / ΣF", "The same for the ring meshes.");
  text += per_planet(result, ring_planet, sharing_waveform, "N F / ΣF", first_cycles);
  text += "<h3>Dynamic factor of the sun meshes</h3>\n" +
          per_planet(result, sun_planet, factor, "F / mean mesh force",
                     "Line: largest force of each mesh cycle; band: down to the smallest." + cut);
  text += per_planet(result, sun_planet, waveform, "F / mean mesh force", first_cycles);
  text += "<h3>Dynamic factor of the ring meshes</h3>\n" +
          per_planet(result, ring_planet, factor, "F / mean mesh force", "As above.");
  text += per_planet(result, ring_planet, waveform, "F / mean mesh force", first_cycles);
  text += error_bars(result);
  text += "<h3>Spectrum of the mesh forces</h3>\n<p>Sun mesh</p>\n" + spectra(result, sun_planet) +
          "<p>Ring mesh</p>\n" + spectra(result, ring_planet);
  return text;
}

}  // namespace annulus::app
