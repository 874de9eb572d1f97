#include "app/report/report_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/plan/mesh_model.h"
#include "app/report/report_parts.h"
#include "app/report/svg_axial.h"
#include "app/report/svg_dimension.h"
#include "app/report/svg_teeth.h"
#include "core/units.h"
#include "geometry/gear_places.h"
#include "geometry/pin_gear_outline.h"

namespace annulus::app {

namespace {

using geometry::Gear;
using geometry::GearPair;

constexpr const char* drawings_heading = "<h2 id=\"drawings\">Geometry to scale</h2>\n";

double bore_radius(const HubGearInput& gear) { return gear.bore_diameter.value_or(0) / 2; }

/// Diameters of the gears, mm.
HtmlTable diameter_table() {
  return {.head = {"", "teeth", "tip ⌀, mm", "root ⌀, mm", "base ⌀, mm", "reference ⌀, mm", "bore or outside ⌀, mm"},
          .rows = {},
          .css_class = "numbers"};
}
void add_gear(HtmlTable& table, const std::string& name, const Gear& gear, double other_radius) {
  table.rows.push_back({escape(name), fmt::format("{}", gear.teeth()), mm_text(2 * gear.tip_radius()),
                        mm_text(2 * gear.root_radius()), mm_text(2 * gear.base_radius()),
                        mm_text(2 * gear.reference_radius()), other_radius > 0 ? mm_text(2 * other_radius) : "–"});
}

/// Whether both draw the same teeth in mesh.
bool same_teeth(const GearPair& a, const GearPair& b) {
  const auto& p = a.wheel();
  const auto& q = b.wheel();
  return p.teeth() == q.teeth() && p.tip_radius() == q.tip_radius() && p.root_radius() == q.root_radius() &&
         p.form_radius() == q.form_radius() && p.parameters().profile_shift == q.parameters().profile_shift;
}

std::string helical_note(double helix_angle) {
  return helix_angle == 0 ? "" : " Helical teeth are shown in the transverse section at z = 0.";
}

/// What the enlarged teeth show.
std::string teeth_words(const std::string& planet, const std::string& wheels) {
  return fmt::format(
      "teeth in mesh at phase 0, in which driving flanks meet in the pitch point C if the path of contact reaches it; "
      "it ends at A with the tip of the {} and at E with that of the {}.",
      wheels, planet);
}

/// Sun and planets of any stage: the planets at their angles, `places` their tooth 0.
void add_sun_and_planets(TransverseSection& section, const Scene& scene, const GearPair& sun_mesh, double sun_angle,
                         const std::vector<std::pair<double, double>>& planets, const std::string& id) {
  section.gears.push_back(
      {{.gear = sun_mesh.wheel(), .id = id + "-sun", .fill = sun_fill, .inner_radius = bore_radius(scene.sun)},
       {{Eigen::Vector2d::Zero(), sun_angle}}});
  TransverseSection::Gears list{
      {.gear = sun_mesh.planet(), .id = id + "-planet", .fill = planet_fill, .inner_radius = bore_radius(scene.planet)},
      {}};
  for (const auto& [phi, angle] : planets) list.places.push_back({polar(sun_mesh.centre_distance(), phi), angle});
  section.gears.push_back(std::move(list));
  section.lengths.push_back({Eigen::Vector2d::Zero(), section.gears.back().places.front().centre, 0, "a = "});
}

/// An arc gear among its pins at crank angle 0, with both pitch circles.
TransverseSection arc_section(const dynamics::ArcToothMesh& arc) {
  const double reach = arc.pin_circle_radius + arc.pin_radius;
  TransverseSection section{
      .title = "Arc gear among its pins: transverse section",
      .label = fmt::format("Arc gear of {} teeth among {} pins of diameter {} mm on a circle of {} mm, to scale; "
                           "eccentricity {} mm",
                           arc.pins - 1, arc.pins, mm_text(2 * arc.pin_radius), mm_text(2 * arc.pin_circle_radius),
                           mm_text(arc.eccentricity)),
      .outside_radius = reach};
  const Eigen::Vector2d gear_centre(arc.eccentricity, 0), axis(0, 0);
  constexpr int steps = 60;
  auto outline = geometry::pin_gear_outline({arc.pins, arc.eccentricity, arc.pin_circle_radius, arc.pin_radius}, steps);
  for (auto& point : outline) point += gear_centre;
  section.bodies.push_back(
      {std::move(outline), std::string("fill=\"") + wheel_fill + "\" stroke=\"#2c3a48\" stroke-width=\"0.9\""});
  for (int i = 0; i < arc.pins; ++i)
    section.circles.push_back({polar(arc.pin_circle_radius, 2 * std::numbers::pi * i / arc.pins), arc.pin_radius,
                               "fill=\"#D55E00\" fill-opacity=\"0.6\" stroke=\"#7a3600\" stroke-width=\"0.8\""});
  section.circles.push_back({axis, arc.pin_circle_radius, pitch_circle_style});
  section.circles.push_back({axis, arc.eccentricity * arc.pins, pitch_circle_style});
  section.circles.push_back({gear_centre, arc.pitch_radius(), pitch_circle_style});
  return section;
}

std::string arc_words(const dynamics::ArcToothMesh& arc) {
  return fmt::format(
      " Below: the first of the arc gears, {} teeth on an eccentricity of {}, among the {} pins of the housing "
      "(orange, "
      "⌀ {} on a circle of ⌀ {}); dash-dotted the pitch circles of both, which touch in the pitch point. Its outline "
      "is "
      "the one that the pins envelop; arcs of {} replace the flanks of it that carry.",
      arc.pins - 1, mm_text(arc.eccentricity), arc.pins, mm_text(2 * arc.pin_radius),
      mm_text(2 * arc.pin_circle_radius), mm_text(arc.arc_radius));
}

}  // namespace

TransverseSection stage_section(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                const std::string& id) {
  const auto& input = scene.rings.at(ring);
  const auto& made = geometry.rings.at(ring);
  const auto& set = made.set;
  const auto stand = geometry::stage_places(set);
  const auto structure = ring_structure(input);
  TransverseSection section{.title = input.name + ": transverse section",
                            .label = fmt::format("{}: transverse section to scale, sun of {} teeth, {} planets of {}, "
                                                 "ring of {}, {}; outside diameter {} mm, centre distance {} mm",
                                                 input.name, set.sun().teeth(), set.planets(), set.planet().teeth(),
                                                 set.ring().teeth(), ring_structure(input).words().description,
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

std::string drawings_section(const RunResult& result) {
  const auto& scene = result.scene;
  const auto& rings = result.geometry.rings;
  std::string text =
      std::string(drawings_heading) +
      "<p>All lengths in millimetres. Sun, planets and ring stand as they mesh: the sun turns counter-clockwise and "
      "touches planet 1 (at the top) in the pitch point." +
      helical_note(scene.stage.helix_angle) + "</p>\n";
  HtmlTable table = diameter_table();
  add_gear(table, "sun", rings.front().set.sun(), bore_radius(scene.sun));
  add_gear(table, "planet", rings.front().set.planet(), bore_radius(scene.planet));
  for (const auto& ring : rings) add_gear(table, "ring, " + ring.name, ring.set.ring(), ring.outside_radius);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const auto& ring = rings[i];
    const auto& input = scene.rings[i];
    const std::string id = fmt::format("drawing{}", i);
    const AxialSection axial{
        .title = ring.name + ": axial section of the ring",
        .label = fmt::format("{}: axial section of the ring to scale, {}, face width {} mm, outside diameter {} mm",
                             ring.name, ring_structure(input).words().description, mm_text(scene.stage.face_width),
                             mm_text(2 * ring.outside_radius)),
        .ring = ring.set.ring(),
        .outside_radius = ring.outside_radius,
        .structure = ring_structure(input)};
    text += figure({to_svg(stage_section(scene, result.geometry, i, id)), to_svg(axial)}, "",
                   fmt::format("<b>{}</b>: {}. Left: transverse section. Right: upper half of the ring in axial "
                               "section, teeth pale; orange: what holds it.",
                               escape(ring.name), ring_structure(input).words().description));
    const auto same =
        std::find_if(rings.begin(), rings.begin() + static_cast<std::ptrdiff_t>(i),
                     [&](const auto& other) { return same_teeth(other.set.ring_mesh(), ring.set.ring_mesh()); });
    if (same != rings.begin() + static_cast<std::ptrdiff_t>(i)) continue;
    std::vector<std::string> pictures;
    if (i == 0)
      pictures.push_back(
          to_svg(TeethInMesh{.title = "Sun and planet in mesh", .id = id + "-outer", .wheel_name = "sun"},
                 ring.set.sun_mesh()));
    pictures.push_back(to_svg(TeethInMesh{.title = ring.name + ": ring and planet in mesh",
                                          .id = id + "-inner",
                                          .wheel_name = "ring",
                                          .wheel_outside_radius = ring.outside_radius},
                              ring.set.ring_mesh()));
    text += figure(pictures, "", "The " + teeth_words("planet", i == 0 ? "sun or ring" : "ring"));
  }
  return text + html(table);
}

std::string drawings_section(const PairRunResult& result) {
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
  HtmlTable table = diameter_table();
  add_gear(table, "pinion", gears.planet(), bore_radius(scene.pinion));
  add_gear(table, "wheel", gears.wheel(), bore_radius(scene.wheel));
  return drawings_heading +
         figure({to_svg(section), to_svg(TeethInMesh{.title = "Pinion and wheel in mesh",
                                                     .id = "pair-teeth",
                                                     .planet_name = "pinion",
                                                     .wheel_name = "wheel"},
                                         gears)},
                "",
                "All lengths in millimetres. Left: the pair. Right: its " + teeth_words("pinion", "wheel") +
                    helical_note(scene.stage.helix_angle)) +
         html(table);
}

std::string drawings_section(const TwoKVResult& result) {
  const auto& scene = result.scene;
  const auto pair = sun_planet_pair(scene);
  TransverseSection section{
      .title = "Sun and planets: transverse section",
      .label = fmt::format("Sun and planets: transverse section to scale, sun of {} teeth, {} planets of {}; centre "
                           "distance {} mm",
                           pair.wheel().teeth(), scene.stage.planets, pair.planet().teeth(),
                           mm_text(pair.centre_distance()))};
  std::vector<std::pair<double, double>> planets;
  for (int n = 0; n < scene.stage.planets; ++n) {
    const double turn = static_cast<double>(n) / scene.stage.planets, phi = 2 * std::numbers::pi * turn;
    planets.emplace_back(phi, geometry::planet_place(pair, phi, std::fmod(turn * pair.wheel().teeth(), 1.0)));
  }
  add_sun_and_planets(section, scene, pair, geometry::pair_places(pair).wheel, planets, "reducer");
  std::vector<std::string> pictures = {
      to_svg(section),
      to_svg(TeethInMesh{.title = "Sun and planet in mesh", .id = "reducer-teeth", .wheel_name = "sun"}, pair)};
  std::string words =
      "All lengths in millimetres. Left: the involute stage. Right: its " + teeth_words("planet", "sun");
  if (result.arc) {
    pictures.push_back(to_svg(arc_section(*result.arc)));
    words += arc_words(*result.arc);
  }
  HtmlTable table = diameter_table();
  add_gear(table, "sun", pair.wheel(), bore_radius(scene.sun));
  add_gear(table, "planet", pair.planet(), bore_radius(scene.planet));
  return drawings_heading + figure(pictures, "", words) + html(table);
}

}  // namespace annulus::app
