#include "fem/contact/hertz.h"

#include <algorithm>
#include <cmath>

namespace annulus::fem {

double hertz_half_width(double line_load, double relative_curvature, const Material& material) {
  const double modulus = material.youngs_modulus / (2 * (1 - material.poisson_ratio * material.poisson_ratio));
  return std::sqrt(4 * line_load / (M_PI * modulus * relative_curvature));
}

double hertz_half_width(const FlankContact& flanks, double roll, double line_load, const Material& material) {
  const double within = std::clamp(roll, flanks.pair().roll_length_low(), flanks.pair().roll_length_high());
  const double normal_factor = std::cos(flanks.pair().pinion().base_helix_angle());
  return hertz_half_width(line_load, normal_factor * flanks.relative_curvature(within), material);
}

}  // namespace annulus::fem
