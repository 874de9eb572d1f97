#include "app/systems/planetary/stage_supports.h"

#include <cmath>

#include "app/model/stiff_supports.h"

namespace annulus::app {

using geometry::StageMember;

double torsional_support(const Scene& scene, StageMember member) {
  const auto& s = scene.supports;
  const auto& given = member == StageMember::sun    ? s.sun_torsional
                      : member == StageMember::ring ? s.ring_torsional
                                                    : s.carrier_torsional;
  return given.value_or(scene.stage.held == member ? rigid : 0);
}

SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh) {
  SupportInput s = scene.supports;
  const double n = scene.stage.planets, both = sun_mesh + ring_mesh, accuracy = scene.accuracy;
  s.sun = rigid_if_stiff(s.sun, n * sun_mesh, accuracy);
  s.ring = rigid_if_stiff(s.ring, n * ring_mesh, accuracy);
  const auto torsional = [&](StageMember member, double meshes) {
    const double given = torsional_support(scene, member);
    return scene.stage.held == member ? rigid_if_stiff(given, n * meshes, accuracy) : given;
  };
  s.sun_torsional = torsional(StageMember::sun, sun_mesh);
  s.ring_torsional = torsional(StageMember::ring, ring_mesh);
  s.carrier_torsional = torsional(StageMember::carrier, both);
  s.carrier = rigid_if_stiff(s.carrier, n * both, accuracy);
  s.planet = rigid_if_stiff(s.planet, both, accuracy);
  for (auto* own : {&s.planet_radial, &s.planet_tangential})
    for (double& bearing : *own) bearing = rigid_if_stiff(bearing, both, accuracy);
  return s;
}

double bearing_compliance(const Scene& scene, const geometry::PlanetarySet& set) {
  const double as = set.sun_mesh().working_pressure_angle(), ar = set.ring_mesh().working_pressure_angle();
  const double tangential = std::pow(std::cos(as) + std::cos(ar), 2), radial = std::pow(std::sin(as) - std::sin(ar), 2);
  const auto& s = scene.supports;
  double sum = 0;
  for (int n = 0; n < set.planets(); ++n)
    sum += tangential / s.planet_bearing(&SupportInput::planet_tangential, static_cast<std::size_t>(n)) +
           radial / s.planet_bearing(&SupportInput::planet_radial, static_cast<std::size_t>(n));
  return sum / set.planets();
}

}  // namespace annulus::app
