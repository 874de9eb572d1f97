#include "app/systems/shared/sun_and_planets.h"

#include "app/sections/geometry_parts.h"
#include "app/systems/shared/sun_planet_input.h"

namespace annulus::app {

void add_sun_and_planets(TransverseSection& section, const Scene& scene, const geometry::GearPair& sun_mesh,
                         double sun_angle, const std::vector<std::pair<double, double>>& planets,
                         const std::string& id) {
  section.gears.push_back({{.gear = sun_mesh.wheel(),
                            .id = id + "-sun",
                            .fill = sun_fill,
                            .inner_radius = bore_radius(sun_and_planets(scene).sun)},
                           {{Eigen::Vector2d::Zero(), sun_angle}}});
  TransverseSection::Gears list{{.gear = sun_mesh.pinion(),
                                 .id = id + "-planet",
                                 .fill = planet_fill,
                                 .inner_radius = bore_radius(sun_and_planets(scene).planet)},
                                {}};
  for (const auto& [phi, angle] : planets) list.places.push_back({polar(sun_mesh.centre_distance(), phi), angle});
  section.gears.push_back(std::move(list));
  section.lengths.push_back({Eigen::Vector2d::Zero(), section.gears.back().places.front().centre, 0, "a = "});
}

}  // namespace annulus::app
