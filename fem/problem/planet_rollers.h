#pragma once

#include "geometry/gear_pair.h"

namespace annulus::fem {

/// The bore of a planet as the raceway of rollers on a rigid pin, instead of a rigid hub. Rollers push the rim outwards
/// and do not hold it against turning; the planet's other mesh does, under the same load. Many rollers count as an even
/// bed, whose stiffness is such that a rigid rim would make the bearing a RadialBearing.
struct PlanetRollers {
  double stiffness = 0;        ///< N/m, of the whole bearing with a rigid rim and without play
  double play = 0;             ///< m, half the radial clearance
  geometry::GearPair partner;  ///< the other mesh, with the planet as its pinion
};

}  // namespace annulus::fem
