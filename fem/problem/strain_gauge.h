#pragma once

#include <string>

namespace annulus::fem {

/// A strain gauge on the wheel of a loaded mesh, with its place in the wheel's own frame: angles from the middle of
/// tooth 0 in the middle of the common face, as for supports.
struct StrainGauge {
  enum class Place { root, outside };
  enum class Direction { hoop, axial };  ///< hoop: along the surface in the transverse section
  std::string name;
  Place place = Place::root;
  Direction direction = Direction::hoop;
  double angle = 0;   ///< rad; of a root any angle in its tooth space
  double offset = 0;  ///< m, of a root: along its surface from the middle of the tooth space, counter-clockwise
  double length = 0;  ///< m, along the surface in the transverse section, over which the strain is averaged
  double z = 0;       ///< m, from the low end of the common face; solid bodies alone
};

}  // namespace annulus::fem
