#include "fem/problem/solved_pair.h"

#include <utility>

namespace annulus::fem {

geometry::GearPair solved_pair(const geometry::GearPair& pair) {
  const auto &pinion = pair.pinion().parameters(), &wheel = pair.wheel().parameters();
  if (!pair.internal() || (pinion.helix_angle == 0 && !geometry::measured(pinion) && !geometry::measured(wheel)))
    return pair;
  const auto mirrored = [](const geometry::Gear& gear) {
    auto parameters = gear.parameters();
    parameters.helix_angle = -parameters.helix_angle;
    std::swap(parameters.leading_topography, parameters.trailing_topography);
    return geometry::Gear(parameters);
  };
  return {mirrored(pair.pinion()), mirrored(pair.wheel()), pair.centre_distance()};
}

}  // namespace annulus::fem
