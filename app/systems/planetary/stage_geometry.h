#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/gear_geometry.h"
#include "app/systems/planetary/operating_point.h"
#include "app/systems/planetary/planetary_input.h"
#include "geometry/planetary.h"

namespace annulus::app {

/// One ring of the scene with the planetary set it makes.
struct RingGeometry {
  std::string name;
  geometry::PlanetarySet set;
  double outside_radius = 0;  ///< m
};

/// Everything that follows from the scene without computing an elastic body. Sun and planets are the same for all
/// rings, and so is the sun mesh.
struct GearGeometry {
  std::vector<RingGeometry> rings;
  OperatingPoint operating_point;

  [[nodiscard]] const geometry::GearPair& sun_mesh() const { return rings.front().set.sun_mesh(); }
};

/// m. Throws GeometryError when it follows from a gear that cannot exist.
[[nodiscard]] double outside_radius(const Scene& scene, const RingInput& ring);

/// Outside radius in m, when the scene defines it; what is missing is reported elsewhere.
[[nodiscard]] std::optional<double> known_outside(const Scene& scene, const RingInput& ring);

/// Throws GeometryError, naming the ring, when the gears cannot exist or mesh.
[[nodiscard]] GearGeometry make_geometry(const Scene& scene);

}  // namespace annulus::app
