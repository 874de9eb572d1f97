#include "dynamics/figures/peaks.h"

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

Peak peak_of(const Eigen::Ref<const Eigen::RowVectorXd>& values, const std::vector<Eigen::Index>& after_jump) {
  if (after_jump.empty()) return peak_of(values);
  Peak peak;
  peak.sampled = peak.refined = values.maxCoeff();
  if (!std::isfinite(peak.sampled)) return peak;
  // Each smooth stretch by itself: the highest sample of all may stand at a jump and a higher peak elsewhere.
  Eigen::Index begin = 0;
  for (std::size_t i = 0; i <= after_jump.size(); ++i) {
    const Eigen::Index end = i < after_jump.size() ? after_jump[i] : values.size();
    if (end > begin) peak.refined = std::max(peak.refined, peak_of(values.segment(begin, end - begin)).refined);
    begin = end;
  }
  return peak;
}

Peak peak_of_rows(const Eigen::Ref<const Eigen::MatrixXd>& values, const std::vector<Eigen::Index>& after_jump) {
  Peak peak = peak_of(values.row(0), after_jump);
  for (Eigen::Index i = 1; i < values.rows(); ++i) peak = higher(peak, peak_of(values.row(i), after_jump));
  return peak;
}

Peak higher(const Peak& a, const Peak& b) { return {std::max(a.sampled, b.sampled), std::max(a.refined, b.refined)}; }
Peak operator+(const Peak& a, const Peak& b) { return {a.sampled + b.sampled, a.refined + b.refined}; }
Peak operator/(const Peak& peak, double scale) { return {peak.sampled / scale, peak.refined / scale}; }

Peak swing_of(const Eigen::Ref<const Eigen::RowVectorXd>& values) { return peak_of(values) + peak_of(-values); }

Figure figure(const Peak& best, std::initializer_list<Peak> others) {
  Figure result{best.refined, 0};
  if (!std::isfinite(best.refined)) return {best.refined, not_known};
  result.error = best.refined - best.sampled;
  for (const auto& other : others) result.error += std::abs(best.refined - other.refined);
  return result;
}

}  // namespace annulus::dynamics
