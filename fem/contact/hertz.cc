#include "fem/contact/hertz.h"

#include <algorithm>
#include <cmath>

namespace annulus::fem {

double hertz_half_width(double line_load, double relative_curvature, const MeshMaterials& materials) {
  return std::sqrt(4 * line_load / (M_PI * materials.contact_modulus() * relative_curvature));
}

double hertz_half_width(const FlankContact& flanks, double roll, double line_load, const MeshMaterials& materials) {
  const double within = std::clamp(roll, flanks.pair().roll_length_low(), flanks.pair().roll_length_high());
  const double normal_factor = std::cos(flanks.pair().pinion().base_helix_angle());
  return hertz_half_width(line_load, normal_factor * flanks.pair().relative_curvature(within), materials);
}

}  // namespace annulus::fem
