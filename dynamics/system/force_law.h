#pragma once

#include <memory>

#include "core/radial_bearing.h"

namespace annulus::dynamics {

/// Forces over the deflections of some meshes that have a potential.
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

/// That of a bearing over two directions at right angles: along the motion.
[[nodiscard]] std::shared_ptr<const ForceLaw> radial_law(const RadialBearing& bearing);

}  // namespace annulus::dynamics
