#include "dynamics/friction/squeeze_film.h"

#include <cmath>
#include <numbers>

#include "dynamics/friction/flank_friction.h"
#include "dynamics/system/input_checks.h"
#include "geometry/gear_pair.h"

namespace annulus::dynamics {

double squeeze_coefficient(const geometry::GearPair& pair, double viscosity) {
  check_positive(viscosity, "viscosity of the oil");
  return 3 * std::numbers::sqrt2 * std::numbers::pi * viscosity * pair.common_face().width *
         std::pow(pitch_point_radius(pair), 1.5);
}

double transverse_squeeze_coefficient(const geometry::GearPair& pair, double viscosity) {
  // Gap and rate along the normal are those along the transverse line times cos(base helix angle), and so is the force.
  return squeeze_coefficient(pair, viscosity) * std::sqrt(std::cos(pair.pinion().base_helix_angle()));
}

}  // namespace annulus::dynamics
