#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/teeth.h"
#include "app/sections/geometry_parts.h"
#include "app/systems/shared/sun_and_planets.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "geometry/gear_places.h"
#include "geometry/pin_gear_outline.h"

namespace annulus::app {

namespace {

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
      " Below: the first arc gear ({} teeth, eccentricity {}) among the {} pins of the housing (orange, ⌀ {} on a "
      "circle of ⌀ {}). Dash-dotted: both pitch circles, which touch at the pitch point. The outline is the envelope "
      "of the pins. Arcs of radius {} replace its loaded flanks.",
      arc.pins - 1, mm_text(arc.eccentricity), arc.pins, mm_text(2 * arc.pin_radius),
      mm_text(2 * arc.pin_circle_radius), mm_text(arc.arc_radius));
}

}  // namespace

Section drawings_section(const TwoKVResult& result) {
  const auto& scene = result.scene;
  const auto pair = sun_planet_pair(scene);
  TransverseSection section{
      .title = "Sun and planets: transverse section",
      .label = fmt::format("Sun and planets: transverse section to scale, sun of {} teeth, {} planets of {}; centre "
                           "distance {} mm",
                           pair.wheel().teeth(), scene.stage.planets, pair.pinion().teeth(),
                           mm_text(pair.centre_distance()))};
  std::vector<std::pair<double, double>> planets;
  for (int n = 0; n < scene.stage.planets; ++n) {
    const double turn = static_cast<double>(n) / scene.stage.planets, phi = 2 * std::numbers::pi * turn;
    planets.emplace_back(phi, geometry::planet_place(pair, phi, std::fmod(turn * pair.wheel().teeth(), 1.0)));
  }
  add_sun_and_planets(section, scene, pair, geometry::pair_places(pair).wheel, planets, "reducer");
  std::vector<Picture> pictures = {drawn(section), drawn(TeethInMesh{.title = "Sun and planet in mesh",
                                                                     .id = "reducer-teeth",
                                                                     .pinion_name = "planet",
                                                                     .wheel_name = "sun"},
                                                         pair)};
  std::string words =
      "All lengths in millimetres. Left: the involute stage. Right: its " + teeth_words("planet", "sun");
  if (result.arc) {
    pictures.push_back(drawn(arc_section(*result.arc)));
    words += arc_words(*result.arc);
  }
  return geometry_section(Pictures{pictures, {}, words} +
                          diameter_table({{"sun", pair.wheel(), bore_radius(sun_and_planets(scene).sun)},
                                          {"planet", pair.pinion(), bore_radius(sun_and_planets(scene).planet)}}));
}

}  // namespace annulus::app
