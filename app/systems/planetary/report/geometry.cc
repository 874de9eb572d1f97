#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "app/plan/mesh_model.h"
#include "app/report/drawings/axial_section.h"
#include "app/report/drawings/dimension.h"
#include "app/report/drawings/teeth.h"
#include "app/sections/geometry_parts.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/shared/sun_and_planets.h"
#include "app/systems/shared/sun_planet_input.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

/// Whether both draw the same teeth in mesh.
bool same_teeth(const geometry::GearPair& a, const geometry::GearPair& b) {
  const auto drawn_by = [](const geometry::Gear& g) {
    return std::tuple(g.teeth(), g.tip_radius(), g.tip_form_radius(), g.root_radius(), g.form_radius(),
                      g.parameters().profile_shift);
  };
  return drawn_by(a.wheel()) == drawn_by(b.wheel());
}

}  // namespace

TransverseSection stage_section(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                const std::string& id) {
  const auto& input = planetary(scene).rings.at(ring);
  const auto& made = geometry.rings.at(ring);
  const auto& set = made.set;
  const auto stand = geometry::stage_places(set);
  const auto structure = ring_structure(input);
  TransverseSection section{.title = input.name + ": transverse section",
                            .label = fmt::format("{}: transverse section to scale, sun of {} teeth, {} planets of {}, "
                                                 "ring of {}, {}; outside diameter {} mm, centre distance {} mm",
                                                 input.name, set.sun().teeth(), set.planets(), set.planet().teeth(),
                                                 set.ring().teeth(), structure.words().description,
                                                 mm_text(2 * made.outside_radius), mm_text(set.centre_distance())),
                            .ring = TransverseSection::Ring{structure, made.outside_radius, stand.ring},
                            .outside_radius = made.outside_radius};
  section.gears.push_back({{.gear = set.ring(), .id = id + "-ring", .outside_radius = made.outside_radius},
                           {{Eigen::Vector2d::Zero(), stand.ring}}});
  std::vector<std::pair<double, double>> planets;
  planets.reserve(stand.planets.size());
  for (int n = 0; n < set.planets(); ++n)
    planets.emplace_back(set.planet_angle(n), stand.planets[static_cast<std::size_t>(n)]);
  add_sun_and_planets(section, scene, set.sun_mesh(), stand.sun, planets, id);
  return section;
}

Section drawings_section(const RunResult& result) {
  const auto& scene = result.scene;
  const auto& rings = result.geometry.rings;
  Blocks blocks = paragraph(
      "All lengths in millimetres. The sun turns counter-clockwise and touches planet 1 (at the top) in the pitch "
      "point." +
      helical_note(scene.stage.helix_angle));
  std::vector<NamedGear> gears = {{"sun", rings.front().set.sun(), bore_radius(sun_and_planets(scene).sun)},
                                  {"planet", rings.front().set.planet(), bore_radius(sun_and_planets(scene).planet)}};
  for (const auto& ring : rings) gears.push_back({"ring, " + ring.name, ring.set.ring(), ring.outside_radius});
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const auto& ring = rings[i];
    const auto& input = planetary(scene).rings[i];
    const std::string id = fmt::format("drawing{}", i);
    const AxialSection axial{
        .title = ring.name + ": axial section of the ring",
        .label = fmt::format("{}: axial section of the ring to scale, {}, face width {} mm, outside diameter {} mm",
                             ring.name, ring_structure(input).words().description, mm_text(face_width_of(scene, input)),
                             mm_text(2 * ring.outside_radius)),
        .ring = ring.set.ring(),
        .outside_radius = ring.outside_radius,
        .structure = ring_structure(input)};
    blocks += Pictures{{drawn(stage_section(scene, result.geometry, i, id)), drawn(axial)},
                       {},
                       phrase("{}: {}. Left: transverse section. Right: upper half of the ring in axial section, with "
                              "pale teeth. Orange: fixed surface or supports.",
                              bold(ring.name), ring_structure(input).words().description)};
    const auto same =
        std::find_if(rings.begin(), rings.begin() + static_cast<std::ptrdiff_t>(i),
                     [&](const auto& other) { return same_teeth(other.set.ring_mesh(), ring.set.ring_mesh()); });
    if (same != rings.begin() + static_cast<std::ptrdiff_t>(i)) continue;
    std::vector<Picture> pictures;
    if (i == 0)
      pictures.push_back(drawn(
          TeethInMesh{
              .title = "Sun and planet in mesh", .id = id + "-outer", .pinion_name = "planet", .wheel_name = "sun"},
          ring.set.sun_mesh()));
    pictures.push_back(drawn(TeethInMesh{.title = ring.name + ": ring and planet in mesh",
                                         .id = id + "-inner",
                                         .pinion_name = "planet",
                                         .wheel_name = "ring",
                                         .wheel_outside_radius = ring.outside_radius},
                             ring.set.ring_mesh()));
    blocks += Pictures{pictures, {}, "The " + teeth_words("planet", i == 0 ? "sun or ring" : "ring")};
  }
  return geometry_section(blocks + diameter_table(gears));
}

}  // namespace annulus::app
