#include "dynamics/modes/structural_damping.h"

#include <numbers>

#include "dynamics/modes/modes.h"
#include "dynamics/system/input_checks.h"

namespace annulus::dynamics {

void StructuralDamping::check() const {
  check_not_negative(modal_ratio, "modal damping ratio");
  check_not_negative(of_mass, "Rayleigh damping of the mass");
  check_not_negative(of_stiffness, "Rayleigh damping of the stiffness");
}

LumpedSystem with_structural_damping(const LumpedSystem& system, const StructuralDamping& damping) {
  if (!damping.any()) return system;
  LumpedSystemBuilder builder;
  builder.add(system);
  Eigen::MatrixXd sum = damping.of_mass * system.mass() + damping.of_stiffness * system.stiffness();
  if (damping.modal_ratio > 0) {
    const auto found = modes(system);
    for (const auto& mode : found.modes) {
      const Eigen::VectorXd momentum = system.mass() * mode.shape;
      sum += 2 * damping.modal_ratio * (2 * std::numbers::pi * mode.frequency) * momentum * momentum.transpose();
    }
  }
  for (int i = 0; i < system.dofs(); ++i)
    for (int j = 0; j < system.dofs(); ++j)
      if (sum(i, j) != 0) builder.add_damping({{i, 1.0}}, {{j, 1.0}}, sum(i, j));
  const Eigen::VectorXd stiffness = mean_stiffnesses(system);
  for (Eigen::Index m = 0; m < stiffness.size(); ++m)
    builder.add_mesh_damping(static_cast<int>(m), damping.of_stiffness * stiffness[m]);
  return builder.build();
}

}  // namespace annulus::dynamics
