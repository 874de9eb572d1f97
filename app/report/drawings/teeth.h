#pragma once

#include <string>

#include "geometry/gear_pair.h"

namespace annulus::app {

/// A few teeth of two gears at pitch-point contact, enlarged, with what their contact follows from.
struct TeethInMesh {
  std::string title{};
  std::string id{};  ///< makes the identifiers unique within a page
  std::string pinion_name{"pinion"}, wheel_name{"wheel"};
  double wheel_outside_radius = 0;  ///< m, of an internal wheel
};
[[nodiscard]] std::string to_svg(const TeethInMesh& drawing, const geometry::GearPair& pair);

}  // namespace annulus::app
