#pragma once

#include "fem/problem/material.h"

namespace annulus::fem {

/// Moduli of plane strain: what beam and ring formulas need per metre of width.
struct PlaneModuli {
  double young = 0;       ///< E / (1 - nu^2), Pa
  double shear = 0;       ///< G = E / (2 (1 + nu)), Pa
  double dilatation = 0;  ///< (lambda + 2 mu) / mu = 2 (1 - nu) / (1 - 2 nu)
};

[[nodiscard]] inline PlaneModuli plane_strain(const Material& material) {
  const double e = material.youngs_modulus, nu = material.poisson_ratio;
  return {e / (1 - nu * nu), e / (2 * (1 + nu)), 2 * (1 - nu) / (1 - 2 * nu)};
}

}  // namespace annulus::fem
