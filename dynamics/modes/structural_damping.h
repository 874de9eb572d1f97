#pragma once

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Damping of a whole system beside that of its meshes, bearings and shafts.
struct StructuralDamping {
  double modal_ratio = 0;  ///< zeta of every mode at the mean stiffness of the meshes: C = M Phi diag(2 zeta w) Phi^T M
  double of_mass = 0;      ///< 1/s, Rayleigh: C = of_mass x M
  double of_stiffness = 0;  ///< s, Rayleigh: C = of_stiffness x K; of meshes the dampers, with their mean stiffness
  [[nodiscard]] bool any() const { return modal_ratio != 0 || of_mass != 0 || of_stiffness != 0; }
  /// Throws InputError with the value that is negative or not finite.
  void check() const;
};

/// The system with it. A rotation of the whole system is damped by `of_mass` alone.
[[nodiscard]] LumpedSystem with_structural_damping(const LumpedSystem& system, const StructuralDamping& damping);

}  // namespace annulus::dynamics
