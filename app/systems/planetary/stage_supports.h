#pragma once

#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "core/beam.h"
#include "core/radial_bearing.h"
#include "geometry/planetary.h"
#include "geometry/power_flow.h"

/// Supports and planet bearings of a stage as its lumped model takes them.
namespace annulus::app {

/// N/m in u: rigid for the member that is held and none for the others, where the scene does not say.
[[nodiscard]] double torsional_support(const Scene& scene, geometry::StageMember member);

/// N/m, of the pin of each planet: a beam of the material of [material].
[[nodiscard]] double pin_stiffness(const Scene& scene);
/// The beam it is.
[[nodiscard]] Beam pin_of(const Scene& scene);
/// rad, by which a cantilevered pin tilts under a force (N) on the planet; 0 of others.
[[nodiscard]] double pin_tilt(const Scene& scene, double force);

/// The supports of the scene, bearings without clearance with their pins.
[[nodiscard]] SupportInput supports_with_pins(const Scene& scene);

/// The supports by the rule of stiff_supports.h, the torsional ones included. `sun_mesh`, `ring_mesh`: mean stiffness
/// of one mesh, N/m.
[[nodiscard]] SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh);

/// What bearing and pin add to the compliance of a planet's path from sun to ring with all centres held, m/N, the mean
/// of the planets: (cos a_s + cos a_r)^2 over the tangential and (sin a_s - sin a_r)^2 over the radial stiffness. With
/// clearance the motion over the force under `mesh_force` (N) in every mesh.
[[nodiscard]] double bearing_compliance(const Scene& scene, const geometry::PlanetarySet& set, double mesh_force);

/// The law of planet bearings with clearance, with their pins.
[[nodiscard]] RadialBearing bearing_law(const Scene& scene);
/// N, of each planet on its pin per N of its meshes, without its centrifugal force.
[[nodiscard]] double pin_force_per_mesh_force(const geometry::PlanetarySet& set);

}  // namespace annulus::app
