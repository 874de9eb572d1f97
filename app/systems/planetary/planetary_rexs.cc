#include "app/systems/planetary/planetary_rexs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "app/rexs/rexs_writer.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"

namespace annulus::app {

std::string planetary_rexs(const Scene& computed, const std::string& ring) {
  const Scene scene = as_drawn(computed, make_geometry(computed).operating_point);
  const auto found = std::find_if(planetary(scene).rings.begin(), planetary(scene).rings.end(),
                                  [&](const auto& r) { return r.name == ring; });
  if (found == planetary(scene).rings.end()) {
    std::vector<std::string> names;
    for (const auto& r : planetary(scene).rings) names.push_back(r.name);
    throw InputError(fmt::format("{}: has no ring '{}'; its rings are {} (--ring NAME)", scene.file.string(), ring,
                                 fmt::join(names, ", ")));
  }
  const auto set = make_geometry(scene).rings[static_cast<std::size_t>(found - planetary(scene).rings.begin())].set;
  RexsWriter rexs(scene);
  const auto unit = rexs.component("gear_unit", scene.title);
  auto stage = rexs.component("planetary_stage", scene.title);
  rexs.custom_attributes(stage, {"stage", "errors", "supports", "dynamics", "mesh.sun_planet", "mesh.ring_planet"});
  rexs.relation("assembly", {{"assembly", &unit}, {"part", &stage}});
  auto carrier = rexs.component("planet_carrier", "carrier");
  if (planetary(scene).carrier.mass) carrier.attribute("mass_of_component", "kg", *planetary(scene).carrier.mass);
  rexs.custom_attributes(carrier, {"carrier"});
  rexs.relation("assembly", {{"assembly", &stage}, {"part", &carrier}});
  auto sun = rexs.gear("sun", sun_and_planets(scene).sun, set.sun_mesh().wheel());
  rexs.custom_attributes(sun, {"sun"});
  auto annulus = rexs.gear("ring " + found->name, *found, set.ring_mesh().wheel());
  rexs.custom_attributes(annulus, {"ring"}, found->name);
  for (int n = 1; n <= scene.stage.planets; ++n) {
    auto planet = rexs.gear(fmt::format("planet {}", n), sun_and_planets(scene).planet, set.sun_mesh().pinion());
    rexs.custom_attributes(planet, {"planet"});
    const double distance = scene.stage.centre_distance;
    rexs.stage(fmt::format("sun - planet {}", n), distance, stage, sun, planet);
    // As the number of teeth of the ring.
    rexs.stage(fmt::format("planet {} - ring", n), -distance, stage, planet, annulus);
  }
  return rexs.text();
}

std::optional<NewValues> planetary_from_rexs(const RexsFile& file) {
  const auto is_ring = [&](int id) { return file.is(id, "ring_gear"); };
  const auto stages = file.stages();
  std::set<int> rings, planets, suns;
  for (const auto& s : stages) {
    if (is_ring(s.first)) rings.insert(s.first), planets.insert(s.second);
    if (is_ring(s.second)) rings.insert(s.second), planets.insert(s.first);
  }
  if (rings.empty()) return std::nullopt;
  if (rings.size() != 1)
    throw file.refusal(fmt::format("{} ring gears are in mesh; a scene needs a stage with one", rings.size()));
  std::optional<double> distance;
  auto wholes = file.of_type("planetary_stage");
  for (const auto& s : stages) {
    if (is_ring(s.first) || is_ring(s.second))
      for (const auto& whole : file.related("assembly", "part", s.stage, {"assembly"}))
        if (whole.type == "planetary_stage") wholes = {whole};
    if (planets.count(s.first) == planets.count(s.second)) continue;
    const int other = planets.count(s.first) ? s.second : s.first;
    if (is_ring(other)) continue;
    suns.insert(other);
    distance = file.number(file.component(s.stage), "center_distance", "mm");
  }
  if (suns.size() != 1)
    throw file.refusal(
        fmt::format("{} gears other than the ring mesh with the planets; a scene has one sun", suns.size()));
  RexsValues fill(file);
  fill.put_count("stage.planets", static_cast<double>(planets.size()));
  const auto& sun = file.component(*suns.begin());
  fill.common(sun, distance);
  fill.gear(sun, "sun");
  fill.gear(file.component(*planets.begin()), "planet");
  fill.gear(file.component(*rings.begin()), "ring");
  fill.put_text("ring.name", "ring");
  fill.operating_point(sun, "stage.sun_speed_rpm", "stage.sun_torque_Nm");
  for (const auto& carrier : file.of_type("planet_carrier")) {
    fill.put("carrier.mass_kg", file.number(carrier, "mass_of_component", "kg"));
    fill.custom(carrier, "carrier");
  }
  if (wholes.size() == 1) {
    if (!wholes.front().name.empty()) fill.put_text("title", wholes.front().name);
    fill.custom(wholes.front(), "");
  }
  return fill.values;
}

}  // namespace annulus::app
