#include "app/systems/planetary/stage_supports.h"

#include <cmath>

#include "app/model/stiff_supports.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/space_input.h"

namespace annulus::app {

using geometry::StageMember;

double torsional_support(const Scene& scene, StageMember member) {
  const auto& s = planetary(scene).supports;
  const auto& given = member == StageMember::sun    ? s.sun_torsional
                      : member == StageMember::ring ? s.ring_torsional
                                                    : s.carrier_torsional;
  if (given) return *given;
  const bool in_mounts = member == StageMember::ring && scene.own<SpaceInput>().ring_in_mounts();
  return planetary(scene).stage.held == member && !in_mounts ? rigid : 0;
}

Beam pin_of(const Scene& scene) {
  return circular_beam(planetary(scene).supports.pin_diameter.value_or(0), scene.material.youngs_modulus,
                       scene.material.poisson_ratio);
}

double pin_stiffness(const Scene& scene) {
  const double length = planetary(scene).supports.pin_length.value_or(0);
  switch (planetary(scene).supports.planet_pin) {
    case PinMounting::unbending:
      break;
    case PinMounting::between_walls:  // halves side by side; the middle does not turn
      return 2 / pin_of(scene).parallel_shift(length / 2);
    case PinMounting::cantilever:
      return 1 / pin_of(scene).cantilever(length);
    case PinMounting::flexpin:  // the force passes through the middle of the pin: its end does not turn
      return 1 / pin_of(scene).parallel_shift(length);
  }
  return rigid;
}

double pin_tilt(const Scene& scene, double force) {
  if (planetary(scene).supports.planet_pin != PinMounting::cantilever) return 0;
  return force * pin_of(scene).cantilever_tilt(*planetary(scene).supports.pin_length);
}

SupportInput supports_with_pins(const Scene& scene) {
  SupportInput s = planetary(scene).supports;
  const double pin = pin_stiffness(scene);
  if (pin == rigid || s.planet_clearance > 0) return s;
  const auto add_pin = [pin](double& bearing) { bearing = 1 / (1 / bearing + 1 / pin); };
  add_pin(s.planet);
  for (auto* own : {&s.planet_radial, &s.planet_tangential})
    for (double& bearing : *own) add_pin(bearing);
  return s;
}

SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh) {
  SupportInput s = supports_with_pins(scene);
  const double n = scene.stage.planets, both = sun_mesh + ring_mesh, accuracy = scene.accuracy;
  s.sun = rigid_if_stiff(s.sun, n * sun_mesh, accuracy);
  s.ring = rigid_if_stiff(s.ring, n * ring_mesh, accuracy);
  const auto torsional = [&](StageMember member, double meshes) {
    const double given = torsional_support(scene, member);
    return planetary(scene).stage.held == member ? rigid_if_stiff(given, n * meshes, accuracy) : given;
  };
  s.sun_torsional = torsional(StageMember::sun, sun_mesh);
  s.ring_torsional = torsional(StageMember::ring, ring_mesh);
  s.carrier_torsional = torsional(StageMember::carrier, both);
  s.carrier = rigid_if_stiff(s.carrier, n * both, accuracy);
  // The force on a bearing with clearance needs the motion in it.
  s.planet =
      s.planet_clearance > 0 ? as_stiff_as_matters(s.planet, both, accuracy) : rigid_if_stiff(s.planet, both, accuracy);
  for (auto* own : {&s.planet_radial, &s.planet_tangential})
    for (double& bearing : *own) bearing = rigid_if_stiff(bearing, both, accuracy);
  return s;
}

RadialBearing bearing_law(const Scene& scene) {
  return {planetary(scene).supports.planet, planetary(scene).supports.planet_clearance / 2, pin_stiffness(scene)};
}

double pin_force_per_mesh_force(const geometry::PlanetarySet& set) {
  const double as = set.sun_mesh().working_pressure_angle(), ar = set.ring_mesh().working_pressure_angle();
  return std::hypot(std::sin(as) - std::sin(ar), std::cos(as) + std::cos(ar));
}

double bearing_compliance(const Scene& scene, const geometry::PlanetarySet& set, double mesh_force) {
  const double as = set.sun_mesh().working_pressure_angle(), ar = set.ring_mesh().working_pressure_angle();
  const double tangential = std::pow(std::cos(as) + std::cos(ar), 2), radial = std::pow(std::sin(as) - std::sin(ar), 2);
  if (planetary(scene).supports.planet_clearance > 0) {
    const double force = mesh_force * pin_force_per_mesh_force(set);
    return (tangential + radial) * bearing_law(scene).distance(force) / force;
  }
  const auto s = supports_with_pins(scene);
  double sum = 0;
  for (int n = 0; n < set.planets(); ++n)
    sum += tangential / s.planet_bearing(&SupportInput::planet_tangential, static_cast<std::size_t>(n)) +
           radial / s.planet_bearing(&SupportInput::planet_radial, static_cast<std::size_t>(n));
  return sum / set.planets();
}

}  // namespace annulus::app
