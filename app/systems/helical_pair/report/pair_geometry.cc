#include <fmt/format.h>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/teeth.h"
#include "app/sections/geometry_parts.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "geometry/gear_places.h"

namespace annulus::app {

Section drawings_section(const PairRunResult& result) {
  const auto& gears = result.geometry.gears;
  const auto& scene = result.scene;
  const auto stand = geometry::pair_places(gears);
  const Eigen::Vector2d axis(0, 0), centre(gears.centre_distance(), 0);
  TransverseSection section{
      .title = "Pinion and wheel: transverse section",
      .label = fmt::format("Pinion and wheel: transverse section to scale, {} and {} teeth, centre distance {} mm",
                           gears.planet().teeth(), gears.wheel().teeth(), mm_text(gears.centre_distance()))};
  section.gears.push_back(
      {{.gear = gears.wheel(), .id = "pair-wheel", .fill = sun_fill, .inner_radius = bore_radius(scene.wheel)},
       {{axis, stand.wheel}}});
  section.gears.push_back(
      {{.gear = gears.planet(), .id = "pair-pinion", .fill = planet_fill, .inner_radius = bore_radius(scene.pinion)},
       {{centre, stand.planet}}});
  section.lengths.push_back({axis, centre, 0, "a = "});
  PageTable table = diameter_table();
  add_gear(table, "pinion", gears.planet(), bore_radius(scene.pinion));
  add_gear(table, "wheel", gears.wheel(), bore_radius(scene.wheel));
  return geometry_section(Pictures{{drawn(section), drawn(TeethInMesh{.title = "Pinion and wheel in mesh",
                                                                      .id = "pair-teeth",
                                                                      .planet_name = "pinion",
                                                                      .wheel_name = "wheel"},
                                                          gears)},
                                   {},
                                   "All lengths in millimetres. Left: the pair. Right: its " +
                                       teeth_words("pinion", "wheel") + helical_note(scene.stage.helix_angle)} +
                          table);
}

}  // namespace annulus::app
