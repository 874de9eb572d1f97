#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

bool made(const MeshResult& mesh) { return mesh.model.fidelity != "given"; }

/// Secant at the nominal load over one cycle, N/µm; closed. A prescribed wave is sampled densely already.
Series stiffness_curve(const MeshResult& mesh, const ShownCase& shown) {
  const auto curve = cycle_curve(mesh, secant_N_per_um, made(mesh) ? 8 : 1);
  return {.label = shown.name, .x = curve.cycles, .y = curve.value, .colour = shown.colour};
}

Plot cycle_plot(const TwoKVResult& result, bool arc) {
  Plot plot{.title = arc ? "Arc teeth and pins" : "Sun and planet",
            .x_label = "mesh cycle",
            .y_label = "N/µm",
            .x_range = Range{0, 1}};
  RangeFinder range;
  range.add(0);
  for (const auto& shown : shown_cases(result)) {
    plot.series.push_back(stiffness_curve(arc ? shown.result->tables.arc : shown.result->tables.sun, shown));
    range.add(plot.series.back().y);
  }
  plot.y_range = Range{0, range.range().high};
  return plot;
}

PageTable mesh_table(const TwoKVResult& result) {
  PageTable table{.head = {"mesh", "stiffness", "from", "mean, N/µm", "range over the cycle, % of the mean"},
                  .rows = {}};
  for (const auto& shown : shown_cases(result))
    for (const auto* mesh : {&shown.result->tables.sun, &shown.result->tables.arc}) {
      const auto curve = stiffness_curve(*mesh, shown).y;
      const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
      const auto mean = mesh->mean_stiffness();
      table.rows.push_back(
          {mesh->model.label(), shown.name, mesh->model.fidelity,
           measured(mean.value / 1e6, mesh->model.computed() ? mean.error_relative * mean.value / 1e6 : 0),
           fmt::format("{:.1f}", 100e6 * (*high - *low) / mean.value)});
    }
  return table;
}

Blocks arc_part(const TwoKVResult& result) {
  if (!result.arc) return {};
  const auto& arc = *result.arc;
  const auto stage = two_k_v_kinematics(result.scene);
  const double even = stage.arc_torque(), uneven = dynamics::uneven_share * result.scene.output.torque;
  const auto position = dynamics::arc_position(arc, even, 0);
  Plot pins{.title = "Pin forces at phase 0", .x_label = "pin, counted from the line of centres", .y_label = "N"};
  Series bars{.label = "force", .colour = 2, .style = Series::Style::bars};
  for (Eigen::Index i = 0; i < position.force.size(); ++i) {
    bars.x.push_back(static_cast<double>(i));
    bars.y.push_back(position.force[i]);
  }
  const double formula = dynamics::largest_pin_force(arc, even);
  pins.levels.emplace_back(formula, "formula: 4 T/(z r')");
  pins.series.push_back(std::move(bars));
  pins.x_range = Range{-0.5, arc.pins - 0.5};

  Plot over_load{.title = "Mean stiffness over load", .x_label = "torque on one arc gear, N m", .y_label = "N/µm"};
  for (const auto& shown : shown_cases(result)) {
    const auto& mesh = shown.result->tables.arc;
    if (!made(mesh) || mesh.table.loads().size() < 2) continue;
    Series series{.label = shown.name, .colour = shown.colour};
    Series printed{.label = "paper's formula", .colour = 6, .dashed = true};
    for (std::size_t i = 0; i < mesh.table.loads().size(); ++i) {
      const double torque = mesh.table.loads()[i] * arc.pitch_radius();
      series.x.push_back(torque);
      series.y.push_back(mean_at_load(mesh.table, i, secant_N_per_um));
      printed.x.push_back(torque);
      printed.y.push_back(dynamics::printed_stiffness(arc, torque) / 1e6);
    }
    over_load.series.push_back(std::move(series));
    over_load.series.push_back(std::move(printed));
  }
  std::vector<Picture> pictures = {pins};
  if (!over_load.series.empty()) pictures.emplace_back(over_load);
  return heading("Arc teeth on their pins") +
         paragraph(fmt::format(
             "{} of {} pins carry; the largest force is {} N, the paper's formula gives {} N at the same torque of {} "
             "N "
             "m on one gear and {} N at the uneven share of {} of the load. Its stiffness formula gives {} N/µm there.",
             position.loaded, arc.pins, to_text(position.force.maxCoeff(), 4), to_text(formula, 4), to_text(even, 4),
             to_text(dynamics::largest_pin_force(arc, uneven), 4), to_text(dynamics::uneven_share),
             to_text(dynamics::printed_stiffness(arc, uneven) / 1e6, 4))) +
         Pictures{pictures,
                  {{"equilibrium of all pins", 2}, {"the paper's formula (dashed)", 6}},
                  "The gear pushes the pins on one side of the line of centres; the force of a pin rises with its "
                  "lever. Stiffness along the tangent of the pitch point."};
}

}  // namespace

Section reducer_meshes_section(const TwoKVResult& result) {
  Section section{"meshes", "Mesh stiffness"};
  section.blocks = paragraph(
                       "Secant at the load of the scene: of one involute mesh along its line of action, of one arc "
                       "gear along the tangent of the pitch point.") +
                   mesh_table(result) +
                   Pictures{{cycle_plot(result, false), cycle_plot(result, true)}, case_legend(result)};
  for (const auto& shown : shown_cases(result)) {
    const auto& picture = shown.result->tables.sun.picture;
    if (picture.empty()) continue;
    section.blocks += Pictures{.list = {Drawing{picture}},
                               .caption = "Finite-element mesh of planet and sun, held at their bores.",
                               .layout = Pictures::Layout::meshes};
    break;
  }
  section.blocks += arc_part(result);
  return section;
}

}  // namespace annulus::app
