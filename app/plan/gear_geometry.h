#pragma once

#include <string>

#include "app/scene/scene.h"
#include "core/errors.h"
#include "fem/problem/material.h"
#include "geometry/gear.h"

namespace annulus::app {

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

}  // namespace annulus::app
