#include "app/systems/planetary/strain_gauges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// The highest lines of every gauge, with their distance from the nearest multiple of the mesh frequency.
Blocks spectrum_blocks(const Csv& csv, const GaugeReadings& readings, const std::string& ring) {
  constexpr std::size_t first = 3;  // column of the first gauge
  auto plot = wide_plot("Ring " + ring + " in motion", "order of the mesh frequency", "amplitude of the strain, µm/m");
  PageTable table{
      .head = {"gauge", "order of the mesh frequency", "sideband, carrier orders", "frequency, Hz", "amplitude, µm/m"},
      .style = PageTable::Style::numbers};
  for (std::size_t g = 0; g < readings.gauges.size(); ++g) {
    const auto& gauge = readings.gauges[g];
    const double relative = gauge.error / std::max(std::abs(gauge.largest), std::abs(gauge.smallest));
    Series lines{.label = gauge.gauge, .colour = g, .style = Series::Style::dots};
    auto rows = csv.rows;
    for (const auto& row : rows) {
      lines.x.push_back(row[0]);
      lines.y.push_back(row[first + g]);
    }
    plot.series.push_back(std::move(lines));
    constexpr std::size_t shown = 6;
    std::sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return a[first + g] > b[first + g]; });
    for (std::size_t i = 0; i < std::min(shown, rows.size()); ++i) {
      const double order = rows[i][0], teeth = rows[i][1] / order, amplitude = rows[i][first + g];
      table.rows.push_back({gauge.gauge, to_text(order, 5), fmt::format("{:+.4g}", (order - std::round(order)) * teeth),
                            to_text(rows[i][2], 5), measured(amplitude, relative * amplitude)});
    }
  }
  return Pictures{{std::move(plot)}} + table +
         paragraph(
             phrase("Every planet strains the ring in proportion to its force at that moment. Passing planets make "
                    "sidebands of carrier orders about the multiples of the mesh frequency. The error is that of the "
                    "stresses of the ring alone. Table: {}.",
                    code("dynamics/strain_gauge_spectrum.csv")));
}

}  // namespace

Section strain_gauges_section(const RunResult& result) {
  constexpr double micro = 1e-6;
  Section section{"strain-gauges", "Strain gauges"};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.rings[i];
    const auto readings = gauge_readings(result.scene, result.geometry.rings[i].set, ring.mesh);
    if (!readings) continue;
    auto plot = wide_plot("Ring " + ring.name, "angle of planet 1 in the frame of the ring, °", "strain, µm/m");
    PageTable table{.head = {"gauge", "largest, µm/m", "smallest, µm/m", "range, µm/m"},
                    .style = PageTable::Style::numbers};
    std::vector<double> degrees;
    for (const double angle : readings->angle) degrees.push_back(angle / units::deg);
    for (std::size_t g = 0; g < readings->gauges.size(); ++g) {
      const auto& gauge = readings->gauges[g];
      std::vector<double> strain;
      for (const double s : gauge.strain) strain.push_back(s / micro);
      plot.series.push_back({.label = gauge.gauge, .x = degrees, .y = std::move(strain), .colour = g});
      table.rows.push_back({gauge.gauge, measured(gauge.largest / micro, gauge.error / micro),
                            measured(gauge.smallest / micro, gauge.error / micro),
                            measured(gauge.range() / micro, 2 * gauge.error / micro)});
    }
    section.blocks += Pictures{{std::move(plot)}} + table;
    PageTable factors{.head = {"gauges across the face", phrase("K{} as they measure it", subscript("Hβ")),
                               phrase("K{} of the contact", subscript("Hβ"))}};
    for (std::size_t g = 0; g < planetary(result.scene).strain_gauges.size(); ++g) {
      const auto factor = readings->face_load_factor(g);
      if (!factor) continue;
      const auto contact = ring.mesh.face_load_factor();
      factors.rows.push_back(
          {planetary(result.scene).strain_gauges[g].name, to_text(*factor, 4),
           contact ? measured(contact->value, contact->value * contact->error_relative) : std::string("–")});
    }
    if (!factors.rows.empty()) section.blocks += factors;
    if (const auto& response = ring.response; response && !response->gauge_spectrum.rows.empty())
      section.blocks += spectrum_blocks(response->gauge_spectrum, *readings, ring.name);
  }
  if (section.blocks.empty()) return section;
  section.blocks += paragraph(
      "Every planet carries the mean mesh force, and its mesh strains the ring as if it were alone: the strains of all "
      "planets are added. The strain is averaged over the length of the gauge. Positive: tension. The error is that of "
      "the stresses of the ring. As gauges measure it, the face load factor is the largest range over the mean one.");
  return section;
}

}  // namespace annulus::app
