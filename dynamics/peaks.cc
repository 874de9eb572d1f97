#include "dynamics/peaks.h"

#include <algorithm>
#include <cmath>

namespace annulus::dynamics {

Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  Eigen::Index i = 0;
  Peak peak;
  peak.sampled = peak.refined = values.maxCoeff(&i);
  if (i == 0 || i + 1 >= values.size() || !std::isfinite(peak.sampled)) return peak;
  const double rise = values[i] - values[i - 1], fall = values[i] - values[i + 1];
  if (rise + fall > 0) peak.refined += (rise - fall) * (rise - fall) / (8 * (rise + fall));
  return peak;
}

Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  Peak peak = peak_of(values.row(0));
  for (Eigen::Index i = 1; i < values.rows(); ++i) {
    const Peak next = peak_of(values.row(i));
    peak = {std::max(peak.sampled, next.sampled), std::max(peak.refined, next.refined)};
  }
  return peak;
}

Figure figure(const Peak& best, std::initializer_list<Peak> others) {
  Figure result{best.refined, 0};
  if (!std::isfinite(best.refined)) return result;
  result.error = best.refined - best.sampled;
  for (const auto& other : others) result.error += std::abs(best.refined - other.refined);
  return result;
}

}  // namespace annulus::dynamics
