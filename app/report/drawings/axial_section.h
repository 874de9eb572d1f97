#pragma once

#include <string>

#include "fem/problem/ring_structure.h"
#include "geometry/gear.h"

namespace annulus::app {

/// Half of a ring in axial section, to scale, the axis below and left out: rim and teeth over the face width, sleeve
/// and hoop, flange, pins, and where it is held.
struct AxialSection {
  std::string title{}, label{};  ///< `label`: what those hear who cannot see it
  geometry::Gear ring;
  double outside_radius = 0;  ///< m
  fem::RingStructure structure{};
};
[[nodiscard]] std::string to_svg(const AxialSection& section);

}  // namespace annulus::app
