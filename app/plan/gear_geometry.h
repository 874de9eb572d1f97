#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/operating_point.h"
#include "app/scene/scene.h"
#include "core/errors.h"
#include "fem/problem/material.h"
#include "geometry/planetary.h"

namespace annulus::app {

/// One ring of the scene with the planetary set it makes.
struct RingGeometry {
  std::string name;
  geometry::PlanetarySet set;
  double outside_radius = 0;  ///< m
};

/// The second stage of the pipeline: everything that follows from the scene without computing an elastic body.
/// Sun and planets are the same for all rings, and so is the sun mesh.
struct GearGeometry {
  std::vector<RingGeometry> rings;
  OperatingPoint operating_point;

  [[nodiscard]] const geometry::GearPair& sun_mesh() const { return rings.front().set.sun_mesh(); }
};

/// What `make` returns; its GeometryError is thrown with the name of what cannot be made in front.
template <class Make>
auto geometry_of(const std::string& name, Make make) {
  try {
    return make();
  } catch (const GeometryError& error) {
    throw GeometryError(name + ": " + error.what());
  }
}

/// m, its own or that of [stage].
[[nodiscard]] double face_width_of(const Scene& scene, const GearInput& gear);

/// m, of the narrower of two gears: their common face is no wider.
[[nodiscard]] double narrower_face(const Scene& scene, const GearInput& one, const GearInput& other);

/// A gear of the scene. `hand`: 1 for the hand of stage.helix_angle_deg, -1 for the other.
[[nodiscard]] geometry::GearParameters gear_parameters(const Scene& scene, const GearInput& input,
                                                       geometry::GearKind kind, int hand = 1);
[[nodiscard]] geometry::Gear make_gear(const Scene& scene, const GearInput& input, geometry::GearKind kind,
                                       int hand = 1);

/// What a gear is made of: [material], where it does not have a value of its own.
[[nodiscard]] fem::Material material_of(const Scene& scene, const GearInput& gear);

/// m. Throws GeometryError when it follows from a gear that cannot exist.
[[nodiscard]] double outside_radius(const Scene& scene, const RingInput& ring);

/// Outside radius in m, when the scene defines it; what is missing is reported elsewhere.
[[nodiscard]] std::optional<double> known_outside(const Scene& scene, const RingInput& ring);

/// Throws GeometryError, naming the ring, when the gears cannot exist or mesh.
[[nodiscard]] GearGeometry make_geometry(const Scene& scene);

}  // namespace annulus::app
