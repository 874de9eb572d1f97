#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"
#include "app/report/svg_bars.h"
#include "app/report/two_k_v_report.h"
#include "core/units.h"

namespace annulus::app {

namespace {

bool made(const MeshResult& mesh) { return mesh.model.fidelity != "given"; }

/// Secant at the nominal load over one cycle, N/µm; closed.
Series stiffness_curve(const MeshResult& mesh, const ShownCase& shown) {
  Series series{.label = shown.name, .colour = shown.colour};
  const int phases = mesh.table.phases();
  std::vector<double> solved;
  solved.reserve(static_cast<std::size_t>(phases));
  for (int i = 0; i < phases; ++i)
    solved.push_back(mesh.table.at(0, i, static_cast<int>(mesh.nominal)).stiffness_secant / 1e6);
  // A given wave is sampled densely already, and a rectangular one must not be rounded.
  const int pieces = made(mesh) ? 8 : 1;
  const PeriodicCurve through(solved, phases);
  for (int i = 0; i <= phases * pieces; ++i) {
    const double cycle = static_cast<double>(i) / (phases * pieces);
    series.x.push_back(cycle);
    series.y.push_back(pieces == 1 ? solved[static_cast<std::size_t>(i % phases)] : through(cycle));
  }
  return series;
}

std::string cycle_plot(const TwoKVResult& result, bool arc) {
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
  return plot_html(plot);
}

double mean_secant(const MeshResult& mesh, std::size_t load) {
  double sum = 0;
  for (int i = 0; i < mesh.table.phases(); ++i) sum += mesh.table.at(0, i, static_cast<int>(load)).stiffness_secant;
  return sum / mesh.table.phases();
}

std::string mesh_table_html(const TwoKVResult& result) {
  HtmlTable table{.head = {"mesh", "stiffness", "from", "mean, N/µm", "range over the cycle, % of the mean"},
                  .rows = {}};
  for (const auto& shown : shown_cases(result))
    for (const auto* mesh : {&shown.result->tables.sun, &shown.result->tables.arc}) {
      const auto curve = stiffness_curve(*mesh, shown).y;
      const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
      const auto mean = mesh->mean_stiffness();
      std::string name = mesh->model.label();
      table.rows.push_back(
          {name, escape(shown.name), mesh->model.fidelity,
           measured(mean.value / 1e6, mesh->model.computed() ? mean.error_relative * mean.value / 1e6 : 0),
           fmt::format("{:.1f}", 100e6 * (*high - *low) / mean.value)});
    }
  return html(table);
}

std::string arc_part(const TwoKVResult& result) {
  if (!result.arc) return "";
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
      series.y.push_back(mean_secant(mesh, i) / 1e6);
      printed.x.push_back(torque);
      printed.y.push_back(dynamics::printed_stiffness(arc, torque) / 1e6);
    }
    over_load.series.push_back(std::move(series));
    over_load.series.push_back(std::move(printed));
  }
  std::vector<std::string> pictures = {plot_html(pins)};
  if (!over_load.series.empty()) pictures.push_back(plot_html(over_load));
  return fmt::format(
             "<h3>Arc teeth on their pins</h3>\n<p>{} of {} pins carry; the largest force is {} N, the paper's formula "
             "gives {} N at the same torque of {} N m on one gear and {} N at the uneven share of {} of the load. Its "
             "stiffness formula gives {} N/µm there.</p>\n",
             position.loaded, arc.pins, to_text(position.force.maxCoeff(), 4), to_text(formula, 4), to_text(even, 4),
             to_text(dynamics::largest_pin_force(arc, uneven), 4), to_text(dynamics::uneven_share),
             to_text(dynamics::printed_stiffness(arc, uneven) / 1e6, 4)) +
         figure(pictures, legend_html({{"equilibrium of all pins", 2}, {"the paper's formula (dashed)", 6}}),
                "The gear pushes the pins on one side of the line of centres; the force of a pin rises with its lever. "
                "Stiffness along the tangent of the pitch point.");
}

}  // namespace

std::string reducer_meshes_section(const TwoKVResult& result) {
  std::string text =
      "<h2 id=\"meshes\">Mesh stiffness</h2>\n<p>Secant at the load of the scene: of one involute mesh along its line "
      "of "
      "action, of one arc gear along the tangent of the pitch point.</p>\n";
  text += mesh_table_html(result);
  std::vector<std::pair<std::string, std::size_t>> legend;
  for (const auto& shown : shown_cases(result)) legend.emplace_back(shown.name, shown.colour);
  text += figure({cycle_plot(result, false), cycle_plot(result, true)}, legend_html(legend), "");
  for (const auto& shown : shown_cases(result)) {
    const auto& sun = shown.result->tables.sun;
    if (sun.picture.empty()) continue;
    text +=
        "<figure class=\"meshes\"><div class=\"row one\"><div>" + sun.picture +
        "</div></div><figcaption>Finite-element mesh of planet and sun, held at their bores.</figcaption></figure>\n";
    break;
  }
  return text + arc_part(result);
}

}  // namespace annulus::app
