#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/elastic_law.h"

namespace annulus::test {

/// Force and tangent of a law against central differences of its energy and of its force, relative to the largest
/// entries.
struct LawSlopes {
  double force = 0, tangent = 0;
};
inline LawSlopes law_slopes(const ElasticLaw& law, const Eigen::VectorXd& at, double step) {
  const auto state = law.at(at);
  LawSlopes worst;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    Eigen::VectorXd up = at, down = at;
    up[i] += step;
    down[i] -= step;
    const auto high = law.at(up), low = law.at(down);
    worst.force = std::max(worst.force, std::abs((high.energy - low.energy) / (2 * step) - state.force[i]));
    worst.tangent =
        std::max(worst.tangent, ((high.force - low.force) / (2 * step) - state.tangent.col(i)).cwiseAbs().maxCoeff());
  }
  return {worst.force / state.force.cwiseAbs().maxCoeff(), worst.tangent / state.tangent.cwiseAbs().maxCoeff()};
}

}  // namespace annulus::test
