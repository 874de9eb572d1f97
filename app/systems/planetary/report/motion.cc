#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

std::string section_words(const StageMotion& m) {
  if (m.section == "period_1") return "repeats after one error period";
  if (m.section == "period_n") return fmt::format("repeats after {} mesh cycles", m.section_period.value_or(0));
  return m.section == "irregular" ? "does not repeat" : "window too short to decide";
}

PageTable motion_table(const RunResult& result) {
  std::vector<TableRow<StageResponse>> rows;
  const auto responses = responses_of(result);
  for (const auto& declared : dynamics::body_figures()) {
    std::vector<double> values;
    for (const auto& [name, response] : responses)
      if (const auto* entry = response->figures.bodies.find(declared.key)) values.push_back(entry->figure.value);
    if (values.empty()) continue;
    const auto spec = in_readable_unit(declared, values);
    rows.push_back({with_unit(spec.title, spec.axis_label()), [spec](const StageResponse& r) {
                      const auto* entry = r.figures.bodies.find(spec.key);
                      return Text(entry ? measured(entry->figure, spec.scale) : "–");
                    }});
  }
  rows.push_back({"repetition of the motion", [](const StageResponse& r) { return Text(section_words(r.motion)); }});
  return side_by_side(responses, rows);
}

/// Of stages in space: bearings, and where the meshes carry along the face.
Blocks space_tables(const RunResult& result) {
  Blocks blocks;
  for (const auto& [name, response] : responses_of(result))
    blocks += space_blocks(response->motion.space, fmt::format(" of '{}'", name));
  return blocks;
}

/// Equal ranges for both axes around the middle of the data, one for all plots.
void make_square(std::vector<Plot>& plots) {
  double side = 0;
  std::vector<std::pair<double, double>> middles;
  for (const auto& plot : plots) {
    RangeFinder x, y;
    for (const auto& s : plot.series) {
      x.add(s.x);
      y.add(s.y);
    }
    const auto rx = x.range(), ry = y.range();
    side = std::max({side, rx.high - rx.low, ry.high - ry.low});
    middles.emplace_back((rx.low + rx.high) / 2, (ry.low + ry.high) / 2);
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    plots[i].x_range = Range{middles[i].first - side / 2, middles[i].first + side / 2};
    plots[i].y_range = Range{middles[i].second - side / 2, middles[i].second + side / 2};
    plots[i].width = 400;
    plots[i].height = 394;  // the frame inside is a square
  }
}

Blocks orbits(const RunResult& result) {
  std::vector<Plot> plots;
  for (const auto& [name, response] : responses_of(result)) {
    const auto& m = response->motion;
    if (!(response->figures.bodies.value("sun_distance_m") > 0)) continue;  // held
    const Plot orbit = line_plot({.title = name, .x_label = "x, µm", .y_label = "y, µm"}, m.sun_orbit,
                                 {.x = "x_m", .x_scale = 1e6, .y_scale = 1e6, .rows_to = shown_cycles},
                                 {{.column = "y_m", .label = "orbit", .colour = 5}});
    plots.push_back(
        line_plot(orbit, m.poincare, {.x = "sun_x_m", .x_scale = 1e6, .y_scale = 1e6, .rows_to = shown_cycles},
                  {{.column = "sun_y_m", .label = "once per mesh cycle", .colour = 7, .style = Series::Style::dots}}));
  }
  if (plots.empty()) return {};
  make_square(plots);
  return heading("Sun orbit") +
         Pictures{{plots.begin(), plots.end()},
                  {{"orbit", 5}, {"once per mesh cycle", 7}},
                  "Centre of the sun in the frame of the carrier, planet 1 on the x axis; one scale for all."};
}

Blocks poincare_sections(const RunResult& result) {
  std::vector<Plot> plots;
  for (const auto& [name, response] : responses_of(result)) {
    Plot plot{.title = name, .x_label = "approach of the sun mesh, µm", .y_label = "approach of the ring mesh, µm"};
    RangeFinder x;
    for (int n = 1; n <= result.scene.stage.planets; ++n) {
      plot = line_plot(std::move(plot), response->motion.poincare,
                       {.x = fmt::format("sun_planet{}_deflection_m", n), .x_scale = 1e6, .y_scale = 1e6},
                       {{.column = fmt::format("ring_planet{}_deflection_m", n),
                         .label = fmt::format("planet {}", n),
                         .colour = static_cast<std::size_t>(n - 1),
                         .style = Series::Style::dots}});
      x.add(plot.series.back().x);
    }
    plot.x_range = x.range();
    plots.push_back(std::move(plot));
  }
  return heading("Poincaré section") +
         Pictures{{plots.begin(), plots.end()},
                  planet_legend(result.scene.stage.planets),
                  "Approach of both meshes of each planet, once per mesh cycle. A motion that repeats after one error "
                  "period has at most one point for each mesh cycle of this period. A motion that does not repeat "
                  "fills a cloud."};
}

}  // namespace

Section motion_section(const RunResult& result) {
  Section section{"motion", "Bearings and sun orbit"};
  if (responses_of(result).empty()) return section;
  const PlanetLines pins{.table = [](const StageResponse& r) -> const Csv& { return r.motion.bearing_forces; },
                         .mesh = "planet",
                         .line = "_resultant_max_N",
                         .low = "_resultant_min_N",
                         .high = "_resultant_max_N",
                         .y_label = "force on the pin, kN",
                         .scale = 1e-3,
                         .level = {}};
  section.blocks =
      motion_table(result) + space_tables(result) + heading("Planet pins") +
      planet_lines(result, pins,
                   "Resultant of the radial and tangential force, including the centrifugal force of the planet. Line: "
                   "largest value of each mesh cycle. Band: from the smallest to the largest value.") +
      orbits(result) + poincare_sections(result);
  return section;
}

}  // namespace annulus::app
