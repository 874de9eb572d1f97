#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/planetary/stage_report_parts.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

std::string branch(const char* mesh, int planet) { return fmt::format("{}{}", mesh, planet + 1); }

/// One plot per ring on one scale, with one line per planet read from `table` of the response.
struct Lines {
  const Csv StageResponse::*table;
  std::string line, low, high;  ///< suffixes of the columns; empty: none
  double cycles = shown_cycles;
};

Pictures per_planet(const RunResult& result, const char* mesh, const Lines& lines, const char* y_label,
                    const Text& caption) {
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
  return {on_one_scale(plots, range), planet_legend(planets), caption};
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

Blocks spectra(const RunResult& result, const char* mesh) {
  constexpr int listed = 4;
  std::vector<Plot> plots;
  PageTable table{.head = {"highest lines"}, .style = PageTable::Style::numbers};
  for (int i = 0; i < listed; ++i) table.rows.push_back({fmt::format("{}", i + 1)});
  double highest = 0;
  for (const auto* ring : rings_with_response(result)) {
    const auto spectrum = spectrum_of(*ring, branch(mesh, 0));
    const auto lines = dynamics::highest_lines(spectrum, listed);
    table.head.push_back(ring->name);
    for (std::size_t i = 0; i < listed; ++i)
      table.rows[i].push_back(
          i < lines.size() ? phrase("{:.2f} kN {}", lines[i].amplitude / 1e3, muted("at " + order_text(lines[i])))
                           : Text());
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
  std::vector<Picture> pictures;
  for (auto& plot : plots) {
    plot.y_range = Range{0, 1.08 * highest};
    plot.x_range = Range{0, plot.series.front().x.back()};
    pictures.emplace_back(plot);
  }
  return Pictures{pictures,
                  {},
                  fmt::format("Force of planet 1 without its mean. Order 1 is the mesh frequency, {:.1f} Hz; lines "
                              "beside whole orders are sidebands of the errors.",
                              result.geometry.operating_point.mesh_frequency)} +
         table;
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

Blocks error_bars(const RunResult& result) {
  PageTable table{.head = {"sun meshes", "value ± error", "discretisation", "local contact", "condensation",
                           "table interpolation", "time integration", "model choice"},
                  .style = PageTable::Style::numbers};
  for (const auto* ring : rings_with_response(result)) {
    table.rows.push_back({ring->name});
    for (const auto& [name, f, e] : explained_figures(*ring->response))
      table.rows.push_back({name, measured(f.value, f.error), part_text(e.discretisation), part_text(e.contact),
                            part_text(e.condensation), part_text(e.interpolation), part_text(e.integration),
                            part_text(e.model)});
  }
  return heading("What the error bars contain", "error-bars") + table +
         paragraph(
             "Discretisation, local contact, condensation and model choice: the larger change when all stiffnesses of "
             "a mesh, or their ripple, are raised by their error estimate, divided as that estimate is; sun mesh plus "
             "ring mesh. Table interpolation: half of the change with every second position of the tables. Time "
             "integration: sampling, steady state and integrator. The error is their sum, and not known when a part "
             "is not; stiffness given as a wave counts as exact.");
}

}  // namespace

Section dynamics_section(const RunResult& result) {
  Section section{"dynamics", "Load sharing and dynamic factors"};
  if (rings_with_response(result).empty()) {
    section.blocks = paragraph("Not asked for.");
    return section;
  }
  const Lines sharing{&StageResponse::load_sharing, "_averaged", "", ""};
  const Lines factor{&StageResponse::dynamic_factor, "_max", "_min", "_max"};
  const Lines waveform{&StageResponse::waveform, "", "", "", 6};
  const Lines sharing_waveform{&StageResponse::sharing_waveform, "", "", "", 6};
  const char *shares = "N F / ΣF", *relative = "F / mean mesh force";
  const char* first_cycles = "The first six mesh cycles of the window, at full resolution.";
  const std::string cut =
      fmt::format(" Windows longer than {:.0f} mesh cycles are cut here; the files hold them whole.", shown_cycles);
  section.blocks =
      heading("Load sharing of the sun meshes") +
      per_planet(
          result, sun_planet, sharing, shares,
          "Each planet's part of the power, forces averaged over a mesh cycle. The coefficient is the highest point." +
              cut) +
      per_planet(result, sun_planet, sharing_waveform, shares, first_cycles) +
      heading("Load sharing of the ring meshes") +
      per_planet(result, ring_planet, sharing, shares, "The same for the ring meshes.") +
      per_planet(result, ring_planet, sharing_waveform, shares, first_cycles) +
      heading("Dynamic factor of the sun meshes") +
      per_planet(result, sun_planet, factor, relative,
                 "Line: largest force of each mesh cycle; band: down to the smallest." + cut) +
      per_planet(result, sun_planet, waveform, relative, first_cycles) + heading("Dynamic factor of the ring meshes") +
      per_planet(result, ring_planet, factor, relative, "As above.") +
      per_planet(result, ring_planet, waveform, relative, first_cycles) + error_bars(result) +
      heading("Spectrum of the mesh forces") + paragraph("Sun mesh") + spectra(result, sun_planet) +
      paragraph("Ring mesh") + spectra(result, ring_planet);
  return section;
}

}  // namespace annulus::app
