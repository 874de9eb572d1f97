#pragma once

namespace annulus::fem {

/// Isotropic linear elasticity; plane problems are plane strain.
struct Material {
  double youngs_modulus = 206e9;  ///< Pa
  double poisson_ratio = 0.3;
  double density = 7850;  ///< kg/m^3
};

}  // namespace annulus::fem
