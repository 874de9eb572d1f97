#include "fem/problem/loaded_mesh_result.h"

#include <cmath>

namespace annulus::fem {

double BodyField::von_mises(std::size_t vertex) const {
  const auto& [xx, yy, zz, xy, yz, zx] = stress[vertex];
  return std::sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 +
                   3 * (xy * xy + yz * yz + zx * zx));
}

SolveCost& SolveCost::operator+=(const SolveCost& other) {
  mesh_seconds += other.mesh_seconds;
  condense_seconds += other.condense_seconds;
  contact_seconds += other.contact_seconds;
  condensed_teeth += other.condensed_teeth;
  reused_teeth += other.reused_teeth;
  return *this;
}

}  // namespace annulus::fem
