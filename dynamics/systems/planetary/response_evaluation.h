#pragma once

#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// The best window, and others whose results should be equal: their differences are errors.
struct ResponseEvidence {
  const ResponseWindow &best, &before, &loose;
  double mean_force = 0;
};

/// Results of the meshes first ... first + planets - 1. `quasi_static_force`: N, planets x positions.
[[nodiscard]] MeshKindResult evaluate_meshes(const ResponseEvidence& evidence, Eigen::Index first, Eigen::Index planets,
                                             const Eigen::MatrixXd& quasi_static_force);

/// See DynamicResponse::force_balance_relative.
[[nodiscard]] double force_balance(const PlanetaryStage& stage, const LumpedSystem& system,
                                   const ResponseWindow& window, const SystemState& begin, const SystemState& end,
                                   int cycles);

}  // namespace annulus::dynamics
