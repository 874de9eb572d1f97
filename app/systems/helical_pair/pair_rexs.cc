#include "app/systems/helical_pair/pair_rexs.h"

#include <algorithm>

#include "app/rexs/rexs_writer.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_model.h"

namespace annulus::app {

std::string pair_rexs(const Scene& scene) {
  const auto geometry = make_pair_geometry(scene);
  RexsWriter rexs(scene);
  auto unit = rexs.component("gear_unit", scene.title);
  rexs.custom_attributes(unit, {"stage", "errors", "dynamics", "mesh.pinion_wheel"});
  auto pinion = rexs.gear("pinion", helical_pair(scene).pinion, geometry.pinion());
  auto wheel = rexs.gear("wheel", helical_pair(scene).wheel, geometry.wheel());
  rexs.custom_attributes(pinion, {"pinion"});
  rexs.custom_attributes(wheel, {"wheel"});
  rexs.stage("pinion - wheel", pair_centre_distance(scene), unit, pinion, wheel);
  return rexs.text();
}

std::optional<NewValues> pair_from_rexs(const RexsFile& file) {
  const auto stages = file.stages();
  const auto pair = std::find_if(stages.begin(), stages.end(), [&](const auto& s) {
    return file.is(s.first, "cylindrical_gear") && file.is(s.second, "cylindrical_gear");
  });
  if (pair == stages.end()) return std::nullopt;
  RexsValues fill(file);
  const auto& first = file.component(pair->first);
  fill.common(first, file.number(file.component(pair->stage), "center_distance", "mm"));
  fill.gear(first, "pinion");
  fill.gear(file.component(pair->second), "wheel");
  for (const auto& unit : file.of_type("gear_unit")) {
    if (!unit.name.empty()) fill.put_text("title", unit.name);
    fill.custom(unit, "");
  }
  return fill.values;
}

}  // namespace annulus::app
