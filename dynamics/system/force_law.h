#pragma once

#include <memory>

#include "core/radial_bearing.h"

namespace annulus::dynamics {

/// Forces over the deflections of some meshes that have a potential. Unlike an ElasticLaw it need not be convex, and it
/// writes where the right-hand side wants it.
class ForceLaw {
 public:
  ForceLaw() = default;
  ForceLaw(const ForceLaw&) = delete;
  ForceLaw& operator=(const ForceLaw&) = delete;
  virtual ~ForceLaw() = default;

  [[nodiscard]] virtual int size() const = 0;  ///< number of meshes
  /// `deflection` (m) and `force` (N): size() numbers each. `tangent`: d force / d deflection (N/m), symmetric, size()
  /// x size() numbers.
  virtual void evaluate(const double* deflection, double* force, double* tangent) const = 0;
  [[nodiscard]] virtual double energy(const double* deflection) const = 0;  ///< J
};

/// Radial force of a bearing over its deflections in two directions at right angles. It acts along the deflection.
[[nodiscard]] std::shared_ptr<const ForceLaw> radial_law(const RadialBearing& bearing);

}  // namespace annulus::dynamics
