#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/ring_structures.h"
#include "core/not_known.h"

namespace annulus::app {

namespace {

/// State of one support at one position.
struct State {
  double angle = 0, contact = 0;  ///< degrees, of the support and of the contact, in the ring's frame
  bool touching = false;
  double radial = 0, tangential = 0;  ///< kN
};

/// States of all supports of a ring, [support][position], the closure position left out.
struct States {
  std::vector<std::vector<State>> supports;
  int per_cycle = 1;
};

States states_of(const MeshResult& mesh) {
  const auto& csv = mesh.pins;
  const auto phase = csv.column("mesh_phase"), pin = csv.column("pin"), angle = csv.column("pin_angle_deg"),
             contact = csv.column("ring_angle_deg"), touching = csv.column("touching"),
             radial = csv.column("radial_force_N"), tangential = csv.column("tangential_force_N");
  States states{.supports = {}, .per_cycle = mesh.table.phases()};
  for (const auto& row : csv.rows) {
    if (row[phase] >= 1) continue;
    const auto i = static_cast<std::size_t>(row[pin]) - 1;
    if (i >= states.supports.size()) states.supports.resize(i + 1);
    states.supports[i].push_back(
        {row[angle], row[contact], row[touching] != 0, row[radial] / 1e3, row[tangential] / 1e3});
  }
  return states;
}

/// A ring that repeats after a few teeth is continued: turned by its period, every support takes the position of
/// another.
void continue_to(States& states, double period_deg, int copies) {
  auto& supports = states.supports;
  const std::size_t positions = supports.front().size();
  for (int copy = 1; copy < copies; ++copy) {
    const double turn = copy * period_deg;
    for (auto& support : supports) {
      const double angle = support.front().angle;
      const auto before = std::find_if(supports.begin(), supports.end(), [&](const auto& other) {
        return std::abs(std::remainder(other.front().angle + turn - angle, 360.0)) < 1e-6;
      });
      if (before == supports.end()) return;
      for (std::size_t k = 0; k < positions; ++k) {
        State state = (*before)[k];
        state.angle = angle;
        state.contact += turn;
        support.push_back(state);
      }
    }
  }
}

/// Place of the contact between the supports, in their numbers, when these follow each other around the ring.
std::vector<std::pair<double, double>> contact_line(const States& states) {
  const auto& supports = states.supports;
  std::vector<std::pair<double, double>> line;
  if (supports.size() < 3) return line;
  for (std::size_t i = 1; i < supports.size(); ++i) {
    if (supports[i].front().angle <= supports[i - 1].front().angle) return line;
  }
  const double first = supports.front().front().angle, last = supports.back().front().angle;
  for (std::size_t k = 0; k < supports.front().size(); ++k) {
    const double contact = first + std::fmod(supports.front()[k].contact - first + 720, 360.0);
    const double cycle = (static_cast<double>(k) + 0.5) / states.per_cycle;
    if (contact > last) {
      line.emplace_back(cycle, not_known);  // between the last and the first one
      continue;
    }
    std::size_t i = 1;
    while (supports[i].front().angle < contact) ++i;
    const double low = supports[i - 1].front().angle, high = supports[i].front().angle;
    line.emplace_back(cycle, static_cast<double>(i) + (contact - low) / (high - low));
  }
  return line;
}

/// Support number over ring position. Columns narrower than two pixels are joined: the largest force is shown.
ColourMap state_map(const RingInput& input, const MeshResult& mesh) {
  const auto structure = ring_structure(input);
  const auto words = structure.words();
  const bool resultant = structure.drawing(0).shown_force == fem::ShownForce::resultant;
  auto states = states_of(mesh);
  constexpr int enough = 24;  // teeth
  const int period = mesh.table.positions();
  continue_to(states, 360.0 * period / input.teeth, std::min((enough + period - 1) / period, input.teeth / period));
  const auto count = states.supports.size(), positions = states.supports.front().size();
  const double cycles = static_cast<double>(positions) / states.per_cycle;
  constexpr std::size_t most_columns = 370;
  const std::size_t stride = (positions + most_columns - 1) / most_columns;
  ColourMap::Panel panel{.x_range = {0, cycles}};
  RangeFinder range;
  range.add(0);
  bool lifted = false;
  for (std::size_t i = 0; i < count; ++i) {
    const double number = static_cast<double>(i + 1);
    for (std::size_t k = 0; k < positions; k += stride) {
      const auto end = std::min(k + stride, positions);
      ColourMap::Cell cell{
          .x = {static_cast<double>(k) / states.per_cycle, static_cast<double>(end) / states.per_cycle},
          .y = {number - 0.5, number + 0.5}};
      for (std::size_t j = k; j < end; ++j) {
        const auto& s = states.supports[i][j];
        if (!s.touching) continue;
        // A pin presses outwards, a bolt pulls as well, a spline flank has two directions.
        const double force = resultant ? std::hypot(s.radial, s.tangential) : s.radial;
        if (!cell.value || std::abs(force) > std::abs(*cell.value)) cell.value = force;
      }
      lifted = lifted || !cell.value;
      if (cell.value) range.add(*cell.value);
      panel.cells.push_back(cell);
    }
  }
  panel.line = contact_line(states);
  ColourMap map{.title = fmt::format("{}: {}", input.name, words.supports),
                .x_label = "ring teeth passed by the planet (mesh cycles)",
                .y_label = words.support + " number",
                .value_label = resultant ? "force, kN" : "radial force, kN",
                .y_range = {0.5, static_cast<double>(count) + 0.5},
                .y_ticks = static_cast<int>(std::min<std::size_t>(count, 8)),
                .values = range.range(0),
                .grey = lifted ? "lifted off" : "",
                .height = static_cast<int>(std::clamp<std::size_t>(130 + 9 * count, 190, 480))};
  map.panels.push_back(std::move(panel));
  return map;
}

Plot force_plot(const std::string& ring, const MeshResult& mesh) {
  Plot plot = wide_plot("Forces around the contact, " + ring, "angle of the support from the contact, °",
                        "force on the support, kN");
  for (const auto& [label, force] :
       {std::pair{"radial, outwards", &State::radial}, {"tangential, counter-clockwise", &State::tangential}}) {
    Series series{.label = label, .colour = plot.series.size(), .style = Series::Style::dots};
    for (const auto& support : states_of(mesh).supports)
      for (const auto& s : support) {
        series.x.push_back(std::remainder(s.angle - s.contact, 360.0));
        series.y.push_back(s.*force);
      }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

Section supports_section(const RunResult& result) {
  Section section{"supports", "Pins and splines"};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.rings[i];
    if (ring.mesh.pins.rows.empty()) continue;
    const auto& input = planetary(result.scene).rings[i];
    const auto words = ring_structure(input).words();
    section.blocks += Pictures{{state_map(input, ring.mesh)},
                               {},
                               "One planet alone at the nominal load travels along the ring, from left to right. Every "
                               "row is a " +
                                   words.support + ", " + words.map_caption +
                                   ". The black line follows the contact of the teeth. Below: the same forces over the "
                                   "angle from the contact."} +
                      Pictures{{force_plot(ring.name, ring.mesh)}};
  }
  return section;
}

}  // namespace annulus::app
