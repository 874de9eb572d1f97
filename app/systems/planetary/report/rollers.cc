#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/roller_loads.h"
#include "core/units.h"

namespace annulus::app {

Section rollers_section(const RunResult& result) {
  Section section{"rollers", "Planet on rollers"};
  std::vector<std::pair<std::string, RollerLoads>> meshes;
  const auto add = [&](const std::string& name, const RingGeometry& ring, const MeshResult& mesh) {
    if (auto loads = roller_loads(result.scene, ring.set, mesh)) meshes.emplace_back(name, std::move(*loads));
  };
  add("sun mesh", result.geometry.rings.front(), result.sun_mesh);
  for (std::size_t i = 0; i < result.rings.size(); ++i)
    add("ring mesh, " + result.rings[i].name, result.geometry.rings[i], result.rings[i].mesh);
  if (meshes.empty()) return section;

  const double per_degree = units::deg;
  auto plot =
      wide_plot("Rollers around the bore", "angle from the direction away from the sun, °", "load of the rollers, N/°");
  PageTable table{.head = {"as solved in", "largest load, N/°", "over that of a round rim", "load zone, °",
                           "load zone of a round rim, °"},
                  .style = PageTable::Style::numbers};
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto& [name, loads] = meshes[i];
    Series of_planet{.label = name, .colour = i},
        round{.label = i == 0 ? "round rim" : "", .colour = 7, .dashed = true};
    for (std::size_t k = 0; k < loads.angle.size(); ++k) {
      for (auto* series : {&of_planet, &round}) series->x.push_back(loads.angle[k] / units::deg);
      of_planet.y.push_back(loads.load[k] * per_degree);
      round.y.push_back(loads.rigid[k] * per_degree);
    }
    plot.series.push_back(std::move(of_planet));
    if (i == 0) plot.series.push_back(std::move(round));
    table.rows.push_back({name, to_text(loads.largest * per_degree, 4), to_text(loads.largest / loads.largest_rigid, 3),
                          to_text(loads.load_zone / units::deg, 3), to_text(loads.rigid_load_zone / units::deg, 3)});
  }
  section.blocks =
      Pictures{{std::move(plot)}} + table +
      paragraph(
          "A planet under its nominal load, at the position where its rollers carry most. Both meshes bend its rim. A "
          "roller carries the load of its share of the circumference. Dashed: what the rollers of a planet carry whose "
          "rim stays round. Counter-clockwise, with the sun below: at -90° the rim leans on the rollers.");
  return section;
}

}  // namespace annulus::app
