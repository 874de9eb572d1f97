#include "app/sections/geometry_parts.h"

#include <fmt/format.h>

#include "app/report/drawings/dimension.h"

namespace annulus::app {

double bore_radius(const HubGearInput& gear) { return gear.bore_diameter.value_or(0) / 2; }

PageTable diameter_table(const std::vector<NamedGear>& gears) {
  PageTable table{
      .head = {"", "teeth", "tip ⌀, mm", "root ⌀, mm", "base ⌀, mm", "reference ⌀, mm", "bore or outside ⌀, mm"},
      .style = PageTable::Style::numbers};
  for (const auto& [name, gear, other] : gears) {
    auto& row = table.rows.emplace_back(std::vector<Text>{name, fmt::format("{}", gear.teeth())});
    for (const double radius :
         {gear.tip_radius(), gear.root_radius(), gear.base_radius(), gear.reference_radius(), other})
      row.emplace_back(radius > 0 ? mm_text(2 * radius) : "–");
  }
  return table;
}

std::string helical_note(double helix_angle) {
  return helix_angle == 0 ? "" : " Helical teeth are shown in the transverse section at z = 0.";
}

std::string teeth_words(const std::string& pinion, const std::string& wheels) {
  return fmt::format(
      "teeth in mesh at phase 0. At this phase the driving flanks touch at the pitch point C, if it lies on the path "
      "of contact. The path of contact ends at A (tip of the {}) and at E (tip of the {}).",
      wheels, pinion);
}

Section geometry_section(const Blocks& blocks) { return {"drawings", "Geometry", blocks, "Geometry to scale"}; }

}  // namespace annulus::app
