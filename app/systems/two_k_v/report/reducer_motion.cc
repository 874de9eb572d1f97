#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

std::vector<double> about_mean(std::vector<double> values, double mean, double unit) {
  for (auto& v : values) v = (v - mean) / unit;
  return values;
}

Plot error_plot(const ShownCase& shown, double turns) {
  const auto& m = *shown.result->motion;
  Plot plot{.title = "Output error, " + shown.name,
            .x_label = "turns of the crank",
            .y_label = "arc seconds",
            .x_range = Range{0, turns}};
  plot.series.push_back(
      {.label = "quasi-static",
       .x = column_values(m.static_error, "crank_turn", turns),
       .y = about_mean(column_values(m.static_error, "error_rad", turns), m.static_error_mean, units::arc_second),
       .colour = 1,
       .dashed = turns < 1});
  plot.series.push_back(
      {.label = "with inertia",
       .x = column_values(m.output_error, "crank_turn", turns),
       .y = about_mean(column_values(m.output_error, "error_rad", turns), m.error_mean, units::arc_second),
       .colour = 0});
  return plot;
}

bool is_multiple(double order, int of) { return std::abs(order / of - std::round(order / of)) < 1e-9; }

std::optional<Plot> spectrum_plot(const ShownCase& shown) {
  const auto& m = *shown.result->motion;
  if (m.spectrum.rows.empty()) return std::nullopt;
  const auto stage = two_k_v_kinematics(shown.result->scene);
  Series sun{.label = "sun mesh", .colour = 0, .style = Series::Style::bars};
  Series arc{.label = "arc mesh", .colour = 2, .style = Series::Style::bars};
  Series rest{.label = "others", .colour = 1, .style = Series::Style::bars};
  const auto order = m.spectrum.column("crank_order"), hertz = m.spectrum.column("frequency_Hz"),
             amplitude = m.spectrum.column("amplitude_rad");
  double top = 0;
  for (const auto& row : m.spectrum.rows) {
    if (row[order] == 0) continue;  // the wind-up
    auto& series = is_multiple(row[order], stage.planet_teeth) ? sun
                   : is_multiple(row[order], stage.arc_teeth)  ? arc
                                                               : rest;
    series.x.push_back(row[hertz]);
    series.y.push_back(row[amplitude] / units::arc_second);
    top = std::max(top, row[hertz]);
  }
  Plot plot{.title = "Its spectrum, " + shown.name,
            .x_label = "frequency, Hz",
            .y_label = "arc seconds",
            .x_range = Range{0, 1.03 * top},
            .width = 900,
            .height = 280};
  for (auto* series : {&rest, &sun, &arc})
    if (!series->x.empty()) plot.series.push_back(std::move(*series));
  return plot;
}

/// Sun mesh cycles shown of the period: enough to see the shape of a cycle and how the next one differs.
constexpr double shown_sun_cycles = 6;

double shown_turns(const ShownCase& shown) { return shown_sun_cycles / shown.result->scene.planet.teeth; }

Plot force_plot(const ShownCase& shown, bool arc) {
  const auto& m = *shown.result->motion;
  const char* prefix = arc ? "arc_pins" : "sun_planet";
  Plot plot{.title = std::string(arc ? "Arc meshes, " : "Sun meshes, ") + shown.name,
            .x_label = "turns of the crank",
            .y_label = "F / mean mesh force",
            .x_range = Range{0, shown_turns(shown)}};
  std::size_t colour = 0;
  for (const auto& column : m.forces.columns) {
    if (!column.starts_with(prefix)) continue;
    plot.series.push_back({.label = column,
                           .x = column_values(m.forces, "crank_turn", shown_turns(shown)),
                           .y = column_values(m.forces, column, shown_turns(shown)),
                           .colour = colour,
                           .dashed = colour % 2 == 1});
    ++colour;
  }
  return plot;
}

PageTable motion_table(const TwoKVResult& result) {
  PageTable table =
      labelled_rows({"output error, peak to peak, arc seconds", "quasi-static, arc seconds",
                     "wind-up, mean, arc seconds", "dynamic factor, sun meshes", "dynamic factor, arc meshes",
                     "time without contact, worst mesh, %", "largest force of an eccentric's bearing, N",
                     "largest Floquet multiplier", "periodic", "torque balance, energy balance"});
  for (const auto& shown : shown_cases(result)) {
    const auto& m = *shown.result->motion;
    const auto factor = [](const std::vector<dynamics::BranchResult>& meshes) {
      const auto top = dynamics::largest_dynamic_factor(meshes);
      return measured(top.value, top.error);
    };
    add_column(
        table, shown.name,
        {error_text(m), m.output_moves() ? to_text(m.static_error_peak_to_peak / units::arc_second, 4) : "0",
         to_text(std::abs(m.error_mean) / units::arc_second, 5), factor(m.sun_planet), factor(m.arc_pins),
         to_text(100 * std::max(m.contact_loss(false), m.contact_loss(true)), 3), to_text(m.largest_bearing_force(), 5),
         m.largest_multiplier ? fmt::format("{:.4f}", *m.largest_multiplier) : "–",
         std::string(m.steady ? "yes" : "no") +
             (m.steady_difference ? fmt::format(" ({:.1e})", *m.steady_difference) : ""),
         (m.torque_balance_relative ? fmt::format("{:.1e}", *m.torque_balance_relative) : "–") +
             (std::isfinite(m.energy_relative) ? fmt::format(", {:.1e}", m.energy_relative) : "")});
  }
  return table;
}

}  // namespace

std::string error_text(const TwoKVMotion& m) {
  if (!m.output_moves()) return "0";
  return measured(m.error_peak_to_peak.value / units::arc_second, m.error_peak_to_peak.error / units::arc_second);
}

Section reducer_motion_section(const TwoKVResult& result) {
  Section section{"motion", "Motion under load"};
  if (!result.own.motion) return section;
  const auto& scene = result.scene;
  const auto& m = *result.own.motion;
  auto& blocks = section.blocks;
  blocks = paragraph(fmt::format(
               "Periodic motion at {} r/min of the output under {} N m, everything that changes in time included: mesh "
               "stiffness and the directions of the eccentrics. One turn of the crank against the carrier ({} Hz) "
               "brings all back: the sun meshes pass at {} Hz, the arc meshes at {} Hz. Output error: turn of the "
               "output less turn of the input over the ratio, about its mean.",
               to_text(scene.output.speed / units::rpm, 5), to_text(scene.output.torque, 5),
               to_text(m.crank_frequency, 5), to_text(m.sun_mesh_frequency, 5), to_text(m.arc_mesh_frequency, 5))) +
           motion_table(result);
  for (const auto& shown : shown_cases(result)) {
    const auto& motion = *shown.result->motion;
    if (dynamics::constant_stiffness(*shown.result->stage)) {
      blocks += paragraph(fmt::format(
          "With {}, the output follows the input but for the wind-up, and all forces stay constant: with constant mesh "
          "stiffness the turning directions of the eccentrics alone excite nothing, for what one crank's bearings "
          "give, the others take.",
          shown_cases(result).size() > 1 ? "the stiffness as given" : "the stiffness of the scene"));
      continue;
    }
    blocks += Pictures{{error_plot(shown, shown_turns(shown)), error_plot(shown, motion.crank_turns)},
                       {{"with inertia", 0}, {"quasi-static", 1}},
                       "A few cycles of the sun mesh, and a whole turn of the crank. Quasi-static: the changing "
                       "stiffness alone, without inertia and damping."};
    if (const auto spectrum = spectrum_plot(shown))
      blocks += Pictures{{*spectrum},
                         {{"multiples of the sun mesh", 0}, {"of the arc mesh", 2}, {"others", 1}},
                         "Spectrum of the output error with inertia."};
    blocks += Pictures{{force_plot(shown, false), force_plot(shown, true)},
                       {{"first", 0}, {"second (dashed)", 1}},
                       "Over the mean force the load asks of each mesh."};
  }
  return section;
}

}  // namespace annulus::app
