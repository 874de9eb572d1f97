#include <fmt/format.h>

#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "app/systems/two_k_v/two_k_v_input.h"

namespace annulus::app {

Blocks arc_pins_blocks(const TwoKVResult& result) {
  if (!result.arc) return {};
  const auto& arc = *result.arc;
  const double even = two_k_v_kinematics(result.scene).arc_torque(),
               uneven = dynamics::uneven_share * two_k_v(result.scene).output.torque;
  const auto position = dynamics::arc_position(arc, even, 0);
  const double formula = dynamics::largest_pin_force(arc, even);
  Series bars{.label = "force", .colour = 2, .style = Series::Style::bars};
  for (Eigen::Index i = 0; i < position.force.size(); ++i) {
    bars.x.push_back(static_cast<double>(i));
    bars.y.push_back(position.force[i]);
  }
  std::vector<Picture> pictures = {Plot{.title = "Pin forces at phase 0",
                                        .x_label = "pin, counted from the line of centres",
                                        .y_label = "N",
                                        .x_range = Range{-0.5, arc.pins - 0.5},
                                        .series = {bars},
                                        .levels = {{formula, "formula: 4 T/(z r')"}}}};
  Plot over_load{.title = "Mean stiffness over load", .x_label = "torque on one arc gear, N m", .y_label = "N/µm"};
  for (const auto& [name, shown] : shown_cases(result)) {
    const auto& mesh = shown->tables.arc;
    if (mesh.model.fidelity == "prescribed" || mesh.table.loads().size() < 2) continue;
    Series computed{.label = name, .colour = 2}, printed{.label = "paper's formula", .colour = 6, .dashed = true};
    for (std::size_t i = 0; i < mesh.table.loads().size(); ++i) {
      const double torque = mesh.table.loads()[i] * arc.pitch_radius();
      computed.x.push_back(torque);
      computed.y.push_back(mean_at_load(mesh.table, i, &StiffnessEntry::stiffness_secant));
      printed.x.push_back(torque);
      printed.y.push_back(dynamics::printed_stiffness(arc, torque) / 1e6);
    }
    over_load.series.insert(over_load.series.end(), {computed, printed});
  }
  if (!over_load.series.empty()) pictures.emplace_back(over_load);
  return heading("Arc teeth on their pins") +
         paragraph(
             fmt::format("{} of {} pins carry load. The largest force is {}. The formula of the paper gives {} at "
                         "the same torque of {} on one gear, and {} at the uneven share of {} of the load. At "
                         "this share, the stiffness formula of the paper gives {}.",
                         position.loaded, arc.pins, text_in_unit(position.force.maxCoeff(), shown_units::force),
                         text_in_unit(formula, shown_units::force), text_in_unit(even, shown_units::torque),
                         text_in_unit(dynamics::largest_pin_force(arc, uneven), shown_units::force),
                         to_text(dynamics::uneven_share),
                         text_in_unit(dynamics::printed_stiffness(arc, uneven), shown_units::stiffness))) +
         Pictures{pictures,
                  {{"equilibrium of all pins", 2}, {"the paper's formula (dashed)", 6}},
                  "The gear pushes the pins on one side of the line of centres. The force of a pin increases with its "
                  "lever arm. The stiffness is that along the tangent at the pitch point."};
}

}  // namespace annulus::app
