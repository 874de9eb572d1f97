#pragma once

#include <cmath>
#include <numbers>

#include "fem/problem/material.h"
#include "geometry/gear.h"

namespace annulus::test {

/// Displacement along the line of action per force and width, m^2/N, by the torsion of the body between root and the
/// fixed radius: u = F' r_b^2 / (4 pi G) |1/r_fixed^2 - 1/r_root^2|, the closed form of a ring under opposite shear
/// tractions. ISO 6336-1 does not contain it.
inline double body_torsion(const geometry::Gear& gear, double fixed_radius, const fem::Material& material) {
  const double shear_modulus = material.youngs_modulus / (2 * (1 + material.poisson_ratio));
  return std::pow(gear.base_radius(), 2) / (4 * std::numbers::pi * shear_modulus) *
         std::abs(1 / std::pow(fixed_radius, 2) - 1 / std::pow(gear.root_radius(), 2));
}

}  // namespace annulus::test
