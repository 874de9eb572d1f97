#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

std::string branch(const char* mesh, int planet) { return fmt::format("{}{}", mesh, planet + 1); }

PlanetLines sharing_lines(const char* mesh) {
  return {.table = [](const StageResponse& r) -> const Csv& { return r.load_sharing; },
          .stem = mesh,
          .line = "_averaged",
          .low = "",
          .high = "",
          .y_label = "N F / ΣF",
          .level = 1};
}
PlanetLines factor_lines(const char* mesh) {
  return {.table = [](const StageResponse& r) -> const Csv& { return r.dynamic_factor; },
          .stem = mesh,
          .line = "_max",
          .low = "_min",
          .high = "_max",
          .y_label = "F / mean mesh force",
          .level = 1};
}
/// The first mesh cycles at full resolution.
PlanetLines waveform_lines(const char* mesh, const Csv StageResponse::*table, const char* y_label) {
  return {.table = [table](const StageResponse& r) -> const Csv& { return r.*table; },
          .stem = mesh,
          .line = "",
          .low = "",
          .high = "",
          .y_label = y_label,
          .cycles = 6,
          .level = 1};
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
  const char* first_cycles = "The first six mesh cycles of the window, at full resolution.";
  const std::string cut =
      fmt::format(" Windows longer than {:.0f} mesh cycles are cut here; the files hold them whole.", shown_cycles);
  auto& blocks = section.blocks;
  const auto add_meshes = [&](const char* mesh, const std::string& words, const std::string& what,
                              const PlanetLines& lines, const Csv StageResponse::*waveform,
                              const std::string& caption) {
    blocks += heading(what + words) + planet_lines(result, lines, caption) +
              planet_lines(result, waveform_lines(mesh, waveform, lines.y_label), first_cycles);
  };
  const std::string share = "Load sharing of the ", factor = "Dynamic factor of the ";
  add_meshes(sun_planet, "sun meshes", share, sharing_lines(sun_planet), &StageResponse::sharing_waveform,
             "Each planet's part of the power, forces averaged over a mesh cycle. The coefficient is the highest "
             "point." +
                 cut);
  add_meshes(ring_planet, "ring meshes", share, sharing_lines(ring_planet), &StageResponse::sharing_waveform,
             "The same for the ring meshes.");
  add_meshes(sun_planet, "sun meshes", factor, factor_lines(sun_planet), &StageResponse::waveform,
             "Line: largest force of each mesh cycle; band: down to the smallest." + cut);
  add_meshes(ring_planet, "ring meshes", factor, factor_lines(ring_planet), &StageResponse::waveform, "As above.");
  blocks += error_bars(result) + heading("Spectrum of the mesh forces") + paragraph("Sun mesh") +
            spectra(result, sun_planet) + paragraph("Ring mesh") + spectra(result, ring_planet);
  return section;
}

}  // namespace annulus::app
