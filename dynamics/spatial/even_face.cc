#include "dynamics/spatial/even_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Integral of k d^2/2 over a part of the face on which d falls from a >= 0 to b, with its derivatives; what is
/// negative does not count. Per unit of k and length.
struct Part {
  double energy = 0, force_a = 0, force_b = 0, aa = 0, ab = 0, bb = 0;
};
Part part(double a, double b) {
  if (b >= 0) return {(a * a + a * b + b * b) / 6, (2 * a + b) / 6, (a + 2 * b) / 6, 1.0 / 3, 1.0 / 6, 1.0 / 3};
  if (a <= 0) return {};
  const double t = a / (a - b);  // share in contact; the derivatives are those of a^3 / (6 (a - b))
  return {a * a * t / 6,           a * t * (3 - t) / 6, a * t * t / 6, t * (3 - 3 * t + t * t) / 3,
          t * t * (3 - 2 * t) / 6, t * t * t / 3};
}

}  // namespace

EvenFace::EvenFace(double stiffness, std::vector<double> stations, std::vector<double> gap)
    : stations_(std::move(stations)), gap_(Eigen::Map<const Eigen::VectorXd>(gap.data(), std::ssize(gap))) {
  if (stations_.size() < 2 || stations_.size() != gap.size() ||
      std::adjacent_find(stations_.begin(), stations_.end(), std::greater_equal<>()) != stations_.end())
    throw InputError(fmt::format("a face needs stations that rise, and a gap at each: {} stations, {} gaps",
                                 stations_.size(), gap.size()));
  if (!(stiffness > 0))
    throw InputError(fmt::format("the stiffness of a mesh must be positive, not {:g} N/m", stiffness));
  stiffness_ = stiffness / face_width();
}

ElasticLaw::State EvenFace::at(const Eigen::VectorXd& approach) const {
  const Eigen::Index n = gap_.size();
  const Eigen::VectorXd d = approach - gap_;
  State state{0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const bool falls = d[i] >= d[i + 1];
    const Eigen::Index high = falls ? i : i + 1, low = falls ? i + 1 : i;
    const double k = stiffness_ * (stations_[i + 1] - stations_[i]);
    const Part p = part(d[high], d[low]);
    state.energy += k * p.energy;
    state.force[high] += k * p.force_a;
    state.force[low] += k * p.force_b;
    state.tangent(high, high) += k * p.aa;
    state.tangent(low, low) += k * p.bb;
    state.tangent(high, low) += k * p.ab;
    state.tangent(low, high) += k * p.ab;
  }
  return state;
}

Eigen::MatrixXd EvenFace::in_contact() const { return at(gap_ + Eigen::VectorXd::Ones(gap_.size())).tangent; }

Eigen::VectorXd EvenFace::line_load(const Eigen::VectorXd& approach, const State&) const {
  return stiffness_ * (approach - gap_).cwiseMax(0);
}

}  // namespace annulus::dynamics
