#include "fem/contact/imposed_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {

ImposedContact::ImposedContact(std::shared_ptr<const ToothPairs> pairs, int slices, Eigen::VectorXd arms)
    : pairs_(std::move(pairs)), slices_(slices), gap_(pairs_->contacts), arms_(std::move(arms)) {
  Eigen::Index at = 0;
  for (const auto& pair : pairs_->pairs)
    for (std::size_t e = 0; e < pair.elements.size(); ++e) {
      gap_[at++] = pair.elements[e].gap;
      slice_.push_back(pair.pinion.elements[e].slice);
      outermost_.push_back(pair.elements[e].outermost);
    }
}

void ImposedContact::factorise(const std::vector<bool>& active) {
  if (active == factorised_) return;
  set_.clear();
  for (std::size_t i = 0; i < active.size(); ++i)
    if (active[i]) set_.push_back(static_cast<int>(i));
  const auto n = static_cast<Eigen::Index>(set_.size());
  factor_.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column = pairs_->compliance.col(set_[static_cast<std::size_t>(j)]);
    for (Eigen::Index i = j; i < n; ++i) factor_(i, j) = column[set_[static_cast<std::size_t>(i)]];
  }
  factorised_.clear();
  if (n > 0 && !lapack::cholesky(factor_))
    throw SolverError(fmt::format("the compliance of {} contacts is not positive definite", n));
  factorised_ = active;
}

ImposedContact::Solution ImposedContact::solve(const Eigen::VectorXd& approach) {
  const auto count = static_cast<std::size_t>(gap_.size());
  const Eigen::Index coordinates = slices_ + 1;
  Eigen::VectorXd overlap = -gap_;
  for (Eigen::Index i = 0; i < gap_.size(); ++i)
    overlap[i] += approach[slice_[static_cast<std::size_t>(i)]] + arms_[i] * approach[slices_];
  const double deepest = overlap.maxCoeff(), rounding = 1e-12;
  Solution solution{0, Eigen::VectorXd::Zero(coordinates), Eigen::MatrixXd::Zero(coordinates, coordinates)};
  if (!(deepest > 0)) return solution;
  if (active_.size() != count) {
    active_.assign(count, false);
    for (std::size_t i = 0; i < count; ++i) active_[i] = overlap[static_cast<Eigen::Index>(i)] > 0.5 * deepest;
  }
  constexpr int most_blocks = 40, most = 4000;
  Eigen::VectorXd force;
  for (solution.iterations = 1;; ++solution.iterations) {
    if (solution.iterations > most)
      throw SolverError(fmt::format("{} flank elements do not settle under an approach of {:.4g} m", count, deepest));
    factorise(active_);
    const auto n = static_cast<Eigen::Index>(set_.size());
    Eigen::MatrixXd right(n, 1);
    for (Eigen::Index i = 0; i < n; ++i) right(i, 0) = overlap[set_[static_cast<std::size_t>(i)]];
    if (n > 0) {
      lapack::solve_lower(factor_, right);
      factor_.triangularView<Eigen::Lower>().transpose().solveInPlace(right);
    }
    force = Eigen::VectorXd::Zero(gap_.size());
    for (Eigen::Index i = 0; i < n; ++i) force[set_[static_cast<std::size_t>(i)]] = right(i, 0);
    Eigen::VectorXd gap = -overlap;
    for (const int j : set_) gap += pairs_->compliance.col(j) * force[j];
    const double zero_force = rounding * (n > 0 ? force.cwiseAbs().maxCoeff() : 0.0), zero_gap = rounding * deepest;
    bool settled = true;
    for (std::size_t i = 0; i < count; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (!(active_[i] ? force[k] < -zero_force : gap[k] < -zero_gap)) continue;
      settled = false;
      active_[i] = !active_[i];
      // One at a time, the first one, where all at once go around in circles: that ends (Murty's rule).
      if (solution.iterations > most_blocks) break;
    }
    if (settled) break;
  }
  const auto n = static_cast<Eigen::Index>(set_.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, coordinates);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int element = set_[static_cast<std::size_t>(i)];
    const int slice = slice_[static_cast<std::size_t>(element)];
    columns(i, slice) = 1;
    columns(i, slices_) = arms_[element];
    solution.force[slice] += force[element];
    solution.force[slices_] += arms_[element] * force[element];
    solution.energy += force[element] * overlap[element] / 2;
    solution.at_window_end = solution.at_window_end || outermost_[static_cast<std::size_t>(element)];
  }
  if (n == 0) return solution;
  lapack::solve_lower(factor_, columns);
  solution.tangent = lapack::gram(columns);
  return solution;
}

}  // namespace annulus::fem
