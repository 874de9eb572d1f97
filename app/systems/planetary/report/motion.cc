#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

std::string section_words(const StageMotion& m) {
  if (m.section == "period_1") return "repeats with the errors";
  if (m.section == "period_n") return fmt::format("repeats after {} mesh cycles", m.section_period.value_or(0));
  return m.section == "irregular" ? "does not repeat" : "window too short to tell";
}

double largest_loss(const dynamics::DynamicResponse& r) {
  double loss = 0;
  for (const auto* kind : {&r.sun_planet, &r.ring_planet}) {
    for (const auto& b : kind->branches) loss = std::max(loss, b.contact_loss);
  }
  return loss;
}

PageTable motion_table(const RunResult& result) {
  PageTable table = labelled_rows(
      {"largest force on a planet pin, kN", "mean tangential force, all pins, kN",
       "largest force on the sun's support, kN", "largest force on the ring's support, kN",
       "largest force on the carrier's support, kN", "mean torque on the housing through the ring, kN m",
       "sun orbit, largest distance from its mean, µm", "contact lost, worst branch", "motion once per mesh cycle"});
  for (const auto* ring : rings_with_response(result)) {
    const auto& m = ring->response->motion;
    double mean = 0;
    for (const double f : m.pin_force_mean_tangential)
      mean += f / static_cast<double>(m.pin_force_mean_tangential.size());
    const double largest = *std::max_element(m.pin_force_max.begin(), m.pin_force_max.end());
    const double values[] = {largest / 1e3,
                             mean / 1e3,
                             m.sun_support_max / 1e3,
                             m.ring_support_max / 1e3,
                             m.carrier_support_max / 1e3,
                             m.ring_torque_mean / 1e3,
                             m.sun_orbit_extent * 1e6};
    std::vector<Text> cells;
    for (const double value : values) cells.emplace_back(fmt::format("{:.2f}", value));
    cells.emplace_back(fmt::format("{:.2f} %", 100 * largest_loss(ring->response->figures)));
    cells.emplace_back(section_words(m));
    add_column(table, ring->name, cells);
  }
  return table;
}

Pictures pin_forces(const RunResult& result) {
  return planet_lines(result,
                      {.table = [](const StageResponse& r) -> const Csv& { return r.motion.bearing_forces; },
                       .stem = "planet",
                       .line = "_resultant_max_N",
                       .low = "_resultant_min_N",
                       .high = "_resultant_max_N",
                       .y_label = "force on the pin, kN",
                       .scale = 1e-3},
                      "Resultant of the radial and tangential force, the planet's centrifugal force included. Line: "
                      "largest of each mesh cycle; band: down to the smallest.");
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

std::vector<double> micrometres(const Csv& csv, const std::string& column, double rows_to = 1e99) {
  return column_values(csv, column, rows_to, 1e6);
}

Blocks orbits(const RunResult& result) {
  std::vector<Plot> plots;
  for (const auto* ring : rings_with_response(result)) {
    const auto& m = ring->response->motion;
    if (m.sun_orbit_largest == 0) continue;  // held
    plots.push_back({.title = ring->name,
                     .x_label = "x, µm",
                     .y_label = "y, µm",
                     .series = {{.label = "orbit",
                                 .x = micrometres(m.sun_orbit, "x_m", shown_cycles),
                                 .y = micrometres(m.sun_orbit, "y_m", shown_cycles),
                                 .colour = 5},
                                {.label = "once per mesh cycle",
                                 .x = micrometres(m.poincare, "sun_x_m", shown_cycles),
                                 .y = micrometres(m.poincare, "sun_y_m", shown_cycles),
                                 .colour = 7,
                                 .style = Series::Style::dots}}});
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
  for (const auto* ring : rings_with_response(result)) {
    const auto& csv = ring->response->motion.poincare;
    Plot plot{
        .title = ring->name, .x_label = "approach of the sun mesh, µm", .y_label = "approach of the ring mesh, µm"};
    for (int n = 0; n < result.scene.stage.planets; ++n) {
      plot.series.push_back({.label = fmt::format("planet {}", n + 1),
                             .x = micrometres(csv, fmt::format("sun_planet{}_deflection_m", n + 1)),
                             .y = micrometres(csv, fmt::format("ring_planet{}_deflection_m", n + 1)),
                             .colour = static_cast<std::size_t>(n),
                             .style = Series::Style::dots});
    }
    RangeFinder x;
    for (const auto& s : plot.series) x.add(s.x);
    plot.x_range = x.range();
    plots.push_back(std::move(plot));
  }
  return heading("Poincaré section") +
         Pictures{{plots.begin(), plots.end()},
                  planet_legend(result.scene.stage.planets),
                  "Dynamic transmission error of both meshes of each planet once per mesh cycle. A motion that repeats "
                  "with the errors leaves no more points than the error period has mesh cycles; a cloud that keeps "
                  "filling is one that does not repeat."};
}

}  // namespace

Section motion_section(const RunResult& result) {
  Section section{"motion", "Bearings and sun orbit"};
  if (!rings_with_response(result).empty())
    section.blocks =
        motion_table(result) + heading("Planet pins") + pin_forces(result) + orbits(result) + poincare_sections(result);
  return section;
}

}  // namespace annulus::app
