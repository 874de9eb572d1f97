#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report_parts.h"

namespace annulus::app {

namespace {

constexpr double shown_cycles = 110;  // two error periods of planets with 55 teeth; longer windows are cut in the plots

std::vector<double> values(const Csv& csv, const std::string& name, double rows_to = 1e99) {
  const auto column = csv.column(name);
  std::vector<double> list;
  for (const auto& row : csv.rows) {
    if (row[0] < rows_to) list.push_back(row[column]);
  }
  return list;
}

std::string branch(const char* mesh, int planet) { return fmt::format("{}{}", mesh, planet + 1); }

std::vector<const RingResult*> with_response(const RunResult& result) {
  std::vector<const RingResult*> list;
  for (const auto& ring : result.rings) {
    if (ring.response) list.push_back(&ring);
  }
  return list;
}

std::vector<std::pair<std::string, std::size_t>> planet_legend(int planets) {
  std::vector<std::pair<std::string, std::size_t>> entries;
  entries.reserve(static_cast<std::size_t>(planets));
  for (int n = 0; n < planets; ++n) entries.emplace_back(fmt::format("planet {}", n + 1), static_cast<std::size_t>(n));
  return entries;
}

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
  for (const auto* ring : with_response(result)) {
    const Csv& csv = (*ring->response).*(lines.table);
    Plot plot{.title = ring->name,
              .x_label = "mesh cycle of the evaluated window",
              .y_label = y_label,
              .levels = {{1.0, ""}}};
    for (int n = 0; n < planets; ++n) {
      const auto name = branch(mesh, n);
      Series series{.label = fmt::format("planet {}", n + 1),
                    .x = values(csv, "mesh_cycle", lines.cycles),
                    .y = values(csv, name + lines.line, lines.cycles),
                    .colour = static_cast<std::size_t>(n)};
      if (!lines.low.empty()) {
        series.low = values(csv, name + lines.low, lines.cycles);
        series.high = values(csv, name + lines.high, lines.cycles);
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
    pictures.push_back(to_svg(plot));
  }
  return figure(pictures, legend_html(planet_legend(planets)), caption);
}

std::string spectra(const RunResult& result, const char* mesh) {
  std::vector<Plot> plots;
  double highest = 0;
  for (const auto* ring : with_response(result)) {
    const Csv& csv = ring->response->spectrum;
    auto frequency = values(csv, "frequency_Hz"), amplitude = values(csv, branch(mesh, 0) + "_N");
    if (frequency.empty()) continue;
    frequency.erase(frequency.begin());  // the mean
    amplitude.erase(amplitude.begin());
    for (auto& a : amplitude) a /= 1e3;
    for (auto& f : frequency) f /= 1e3;
    for (const double a : amplitude) highest = std::max(highest, a);
    plots.push_back(
        {.title = ring->name,
         .x_label = "frequency, kHz",
         .y_label = "amplitude, kN",
         .series = {{.label = "planet 1", .x = frequency, .y = amplitude, .colour = 0, .style = Series::Style::bars}}});
  }
  std::vector<std::string> pictures;
  for (auto& plot : plots) {
    plot.y_range = Range{0, 1.08 * highest};
    plot.x_range = Range{0, plot.series.front().x.back()};
    pictures.push_back(to_svg(plot));
  }
  return figure(pictures, "",
                fmt::format("Force of planet 1 without its mean, up to eight times the mesh frequency of {:.1f} Hz.",
                            result.geometry.operating_point.mesh_frequency));
}

}  // namespace

std::string dynamics_section(const RunResult& result) {
  if (with_response(result).empty())
    return "<h2 id=\"dynamics\">Load sharing and dynamic factors</h2>\n<p>Not asked for.</p>\n";
  std::string text = "<h2 id=\"dynamics\">Load sharing and dynamic factors</h2>\n";
  const Lines sharing{&StageResponse::load_sharing, "_averaged", "", ""};
  const Lines factor{&StageResponse::dynamic_factor, "_max", "_min", "_max"};
  const Lines waveform{&StageResponse::waveform, "", "", "", 6};
  const std::string cut =
      fmt::format(" Windows longer than {:.0f} mesh cycles are cut here; the files hold them whole.", shown_cycles);
  text +=
      "<h3>Load sharing of the sun meshes</h3>\n" +
      per_planet(
          result, sun_planet, sharing, "N F / ΣF",
          "Each planet's part of the power, forces averaged over a mesh cycle. The coefficient is the highest point." +
              cut);
  text += "<h3>Load sharing of the ring meshes</h3>\n" +
          per_planet(result, ring_planet, sharing, "N F / ΣF", "The same for the ring meshes.");
  text += "<h3>Dynamic factor of the sun meshes</h3>\n" +
          per_planet(result, sun_planet, factor, "F / mean mesh force",
                     "Line: largest force of each mesh cycle; band: down to the smallest." + cut);
  text += per_planet(result, sun_planet, waveform, "F / mean mesh force",
                     "The first six mesh cycles of the window, at full resolution.");
  text += "<h3>Dynamic factor of the ring meshes</h3>\n" +
          per_planet(result, ring_planet, factor, "F / mean mesh force", "As above.");
  text += per_planet(result, ring_planet, waveform, "F / mean mesh force",
                     "The first six mesh cycles of the window, at full resolution.");
  text += "<h3>Spectrum of the mesh forces</h3>\n<p>Sun mesh</p>\n" + spectra(result, sun_planet) +
          "<p>Ring mesh</p>\n" + spectra(result, ring_planet);
  return text;
}

}  // namespace annulus::app
