#include "dynamics/spatial/even_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

MeshLaw linear(double stiffness) {
  return [stiffness](double d) { return MeshPoint{stiffness * d * d / 2, stiffness * d, stiffness}; };
}

}  // namespace

EvenFace::EvenFace(MeshLaw law, double stiffness, std::vector<double> stations, std::vector<double> gap)
    : law_(std::move(law)),
      stations_(std::move(stations)),
      gap_(Eigen::Map<const Eigen::VectorXd>(gap.data(), std::ssize(gap))) {
  if (stations_.size() < 2 || stations_.size() != gap.size() ||
      std::adjacent_find(stations_.begin(), stations_.end(), std::greater_equal<>()) != stations_.end())
    throw InputError(fmt::format("a face needs stations that rise, and a gap at each: {} stations, {} gaps",
                                 stations_.size(), gap.size()));
  if (!(stiffness > 0))
    throw InputError(fmt::format("the stiffness of a mesh must be positive, not {:g} N/m", stiffness));
  in_contact_ = integral(linear(stiffness), Eigen::VectorXd::Ones(gap_.size())).tangent;
}

EvenFace::EvenFace(double stiffness, std::vector<double> stations, std::vector<double> gap)
    : EvenFace(linear(stiffness), stiffness, std::move(stations), std::move(gap)) {}

ElasticLaw::State EvenFace::integral(const MeshLaw& law, const Eigen::VectorXd& above_gap) const {
  const double reach = std::sqrt(0.6) / 2;
  constexpr double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const double points[] = {0.5 - reach, 0.5, 0.5 + reach};
  const Eigen::Index n = above_gap.size();
  State state{0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double a = above_gap[i], b = above_gap[i + 1];
    if (a <= 0 && b <= 0) continue;
    const auto station = static_cast<std::size_t>(i);
    const double share = (stations_[station + 1] - stations_[station]) / face_width();
    // The part of the stretch in contact, from 0 to 1.
    const double low = a < 0 ? a / (a - b) : 0.0, high = b < 0 ? a / (a - b) : 1.0;
    for (std::size_t k = 0; k < std::size(points); ++k) {
      const double s = low + (high - low) * points[k], weight = share * (high - low) * weights[k];
      const auto [energy, force, tangent] = law((1 - s) * a + s * b);
      state.energy += weight * energy;
      state.force[i] += weight * (1 - s) * force;
      state.force[i + 1] += weight * s * force;
      state.tangent(i, i) += weight * (1 - s) * (1 - s) * tangent;
      state.tangent(i + 1, i + 1) += weight * s * s * tangent;
      state.tangent(i, i + 1) += weight * s * (1 - s) * tangent;
      state.tangent(i + 1, i) += weight * s * (1 - s) * tangent;
    }
  }
  return state;
}

ElasticLaw::State EvenFace::at(const Eigen::VectorXd& approach) const { return integral(law_, approach - gap_); }

Eigen::VectorXd EvenFace::line_load(const Eigen::VectorXd& approach, const State&) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(gap_.size());
  for (Eigen::Index i = 0; i < load.size(); ++i)
    if (approach[i] > gap_[i]) load[i] = law_(approach[i] - gap_[i]).force / face_width();
  return load;
}

}  // namespace annulus::dynamics
