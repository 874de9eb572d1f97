#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "core/units.h"

namespace annulus::app {

namespace {

Plot error_plot(const std::string& name, const TwoKVMotion& m, double turns) {
  constexpr double arc_seconds = 1 / units::arc_second;
  const LineTable over_turns{.x = "crank_turn", .y_scale = arc_seconds, .rows_to = turns};
  const Plot still = line_plot({.title = "Output error, " + name,
                                .x_label = "turns of the crank",
                                .y_label = "arc seconds",
                                .x_range = Range{0, turns}},
                               m.static_error, over_turns,
                               {{.column = "error_rad",
                                 .label = "quasi-static",
                                 .colour = 1,
                                 .dashed = turns < 1,
                                 .offset = m.static_error_mean}});
  return line_plot(still, m.output_error, over_turns,
                   {{.column = "error_rad", .label = "with inertia", .offset = m.error_mean}});
}

bool is_multiple(double order, int of) { return std::abs(order / of - std::round(order / of)) < 1e-9; }

std::optional<Plot> spectrum_plot(const std::string& name, const TwoKVCase& shown) {
  const auto& spectrum = shown.motion->spectrum;
  if (spectrum.rows.empty()) return std::nullopt;
  const auto stage = two_k_v_kinematics(shown.scene);
  Plot plot{.title = "Spectrum of the output error, " + name,
            .x_label = "frequency, Hz",
            .y_label = "arc seconds",
            .x_range = Range{0, 1.03 * spectrum.rows.back()[spectrum.column("frequency_Hz")]},
            .width = 900,
            .height = 280};
  const auto order = spectrum.column("crank_order");
  const auto kind = [&](double of) {
    return is_multiple(of, stage.planet_teeth) ? 0 : is_multiple(of, stage.arc_teeth) ? 2 : 1;
  };
  for (const auto& [number, label] : {std::pair{1, "others"}, {0, "sun mesh"}, {2, "arc mesh"}}) {
    const int colour = number;
    Csv own = spectrum;  // without the wind-up, of order 0
    std::erase_if(own.rows, [&](const auto& row) { return row[order] == 0 || kind(row[order]) != colour; });
    if (!own.rows.empty())
      plot = line_plot(std::move(plot), own, {.x = "frequency_Hz", .y_scale = 1 / units::arc_second},
                       {{.column = "amplitude_rad",
                         .label = label,
                         .colour = static_cast<std::size_t>(colour),
                         .style = Series::Style::bars}});
  }
  return plot;
}

/// Sun mesh cycles shown of the period: enough to see the shape of a cycle and how the next one differs.
constexpr double shown_sun_cycles = 6;

double shown_turns(const TwoKVCase& shown) { return shown_sun_cycles / sun_and_planets(shown.scene).planet.teeth; }

Plot force_plot(const std::string& title, const std::string& mesh, const TwoKVCase& shown) {
  std::vector<Line> lines;
  for (const auto& column : shown.motion->forces.columns)
    if (column.starts_with(mesh))
      lines.push_back({.column = column, .label = column, .colour = lines.size(), .dashed = lines.size() % 2 == 1});
  return line_plot({.title = title,
                    .x_label = "turns of the crank",
                    .y_label = "F / mean mesh force",
                    .x_range = Range{0, shown_turns(shown)}},
                   shown.motion->forces, {.x = "crank_turn", .rows_to = shown_turns(shown)}, lines);
}

Blocks one_motion(const std::string& name, const TwoKVCase& shown) {
  if (dynamics::constant_stiffness(*shown.stage))
    return paragraph(
        fmt::format("Case “{}”: the output follows the input except for the wind-up, and all forces are constant. The "
                    "turning directions of the eccentrics alone excite no vibration, because the bearings of all "
                    "cranks compensate each other.",
                    name));
  Blocks blocks = Pictures{
      {error_plot(name, *shown.motion, shown_turns(shown)), error_plot(name, *shown.motion, shown.motion->crank_turns)},
      {{"with inertia", 0}, {"quasi-static", 1}},
      "First plot: a few cycles of the sun mesh. Second plot: a whole turn of the crank. Quasi-static: with the "
      "variable stiffness, without inertia and damping."};
  if (const auto spectrum = spectrum_plot(name, shown))
    blocks += Pictures{{*spectrum},
                       {{"multiples of the sun mesh", 0}, {"of the arc mesh", 2}, {"others", 1}},
                       "Output error with inertia."};
  return blocks + Pictures{{force_plot("Sun meshes, " + name, sun_planet, shown),
                            force_plot("Arc meshes, " + name, arc_pins, shown)},
                           {{"first", 0}, {"second (dashed)", 1}},
                           "Relative to the mean force of each mesh under the load."};
}

}  // namespace

std::string error_text(const TwoKVMotion& m) {
  return m.output_moves() ? measured(m.error_peak_to_peak, 1 / units::arc_second) : "0";
}

Blocks motion_checks(const TwoKVResult& result) {
  if (!result.own.motion) return {};
  const auto known = [](const std::optional<double>& x) { return x ? small_text(*x) : std::string("–"); };
  return side_by_side<TwoKVCase>(
      shown_cases(result),
      {{"periodic, difference between windows",
        [=](const TwoKVCase& c) {
          return Text(std::string(c.motion->steady ? "yes" : "no") + ", " + known(c.motion->steady_difference));
        }},
       {"largest Floquet multiplier",
        [](const TwoKVCase& c) {
          const auto& multiplier = c.motion->largest_multiplier;
          return Text(multiplier ? fmt::format("{:.4f}", *multiplier) : "–");
        }},
       {"torque balance, relative", [=](const TwoKVCase& c) { return Text(known(c.motion->torque_balance_relative)); }},
       {"energy balance, relative", [](const TwoKVCase& c) { return Text(small_text(c.motion->energy_relative)); }}});
}

Section reducer_motion_section(const TwoKVResult& result) {
  Section section{"motion", "Motion under load"};
  if (!result.own.motion) return section;
  const auto& output = two_k_v(result.scene).output;
  const auto& m = *result.own.motion;
  std::vector<Text> wind_up;
  for (const auto& [name, shown] : shown_cases(result))
    wind_up.emplace_back(
        fmt::format("{} arc seconds {}", to_text(std::abs(shown->motion->error_mean) / units::arc_second, 5), name));
  section.blocks = paragraph(fmt::format(
      "Periodic motion at {} r/min of the output under {} N m. Mesh stiffness and the directions of the eccentrics "
      "change in time. The motion repeats after one turn of the crank relative to the carrier ({} Hz). The mesh "
      "frequency is {} Hz for the sun meshes and {} Hz for the arc meshes. Output error: rotation of the output less "
      "rotation of the input over the ratio, about its mean. The mean is the wind-up, {}.",
      to_text(output.speed / units::rpm, 5), to_text(output.torque, 5), to_text(m.crank_frequency, 5),
      to_text(m.sun_mesh_frequency, 5), to_text(m.arc_mesh_frequency, 5), joined(wind_up, ", ").plain()));
  for (const auto& [name, shown] : shown_cases(result)) section.blocks += one_motion(name, *shown);
  return section;
}

}  // namespace annulus::app
