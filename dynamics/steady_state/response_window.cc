#include "dynamics/steady_state/response_window.h"

#include <cmath>

namespace annulus::dynamics {

Eigen::MatrixXd averaging_force(const ResponseWindow& window) {
  Eigen::MatrixXd force = window.force;
  const Eigen::Index samples = force.cols();
  if (!window.jumps() || samples < 2) return force;
  // Over the whole window: times late in a run carry few digits of a spacing.
  const double spacing = (window.time[samples - 1] - window.time[0]) / static_cast<double>(samples - 1);
  for (Eigen::Index j = 0; j < window.jump_time.size(); ++j) {
    const double at = (window.jump_time[j] - window.time[0]) / spacing;
    const auto after = static_cast<Eigen::Index>(std::ceil(at - 1e-6));  // a sample on the jump itself is behind it
    // A sample stands for half a spacing on either side; this share of the one that the jump cuts is of the other side.
    const double excess = static_cast<double>(after) - at - 0.5;
    const Eigen::Index cut = excess < 0 ? after : after - 1;
    force.col((cut + samples) % samples) += excess * (window.force_after.col(j) - window.force_before.col(j));
  }
  return force;
}

}  // namespace annulus::dynamics
