#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// Random states about the static equilibrium at time 0. They depend on the system, the seed and their number alone.
class RandomStarts {
 public:
  /// States lie within `size` static mesh deflections of the equilibrium in every DOF, with velocities as of a
  /// vibration of that size at the higher one of mesh frequency and mean natural frequency of a mesh by itself. The
  /// system is referred to. Throws what StaticSolver throws.
  RandomStarts(const LumpedSystem& system, const SteadyProblem& problem, double size, std::uint64_t seed = 1);

  [[nodiscard]] SystemState draw(std::uint64_t number) const;
  /// A state moved by up to a hundredth of the static deflection.
  [[nodiscard]] SystemState beside(SystemState state) const;

 private:
  [[nodiscard]] Eigen::VectorXd random_vector(std::uint64_t number, const char* quantity) const;

  const LumpedSystem& system_;
  std::uint64_t seed_;
  double size_, deflection_, rate_ = 0;
  Eigen::VectorXd equilibrium_;
  std::vector<Eigen::VectorXd> rigid_;
};

}  // namespace annulus::dynamics
