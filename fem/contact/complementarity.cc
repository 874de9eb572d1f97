#include "fem/contact/complementarity.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "core/errors.h"
#include "fem/condensation/lapack.h"
#include "fem/contact/primal_active_set.h"

namespace annulus::fem {
namespace {

/// Equality-constrained solve on the active set.
bool solve_active(const ComplementarityProblem& p, const std::vector<int>& set, ComplementaritySolution& s) {
  const auto n = static_cast<Eigen::Index>(set.size());
  const auto rigid = p.rigid.cols();
  Eigen::MatrixXd c(n, n), e(n, rigid);
  Eigen::VectorXd g(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column = p.compliance.col(set[j]);
    for (Eigen::Index i = j; i < n; ++i) c(i, j) = column[set[i]];  // the lower half is enough
    e.row(j) = p.rigid.row(set[j]);
    g[j] = p.gap[set[j]];
  }
  if (!lapack::cholesky(c))
    throw SolverError(fmt::format("the compliance of {} contacts and supports is not positive definite", n));
  Eigen::MatrixXd right(n, rigid + 1);
  right << e, g;
  lapack::solve_lower(c, right);
  c.triangularView<Eigen::Lower>().transpose().solveInPlace(right);
  const Eigen::MatrixXd ce = right.leftCols(rigid);
  const Eigen::VectorXd cg = right.col(rigid);
  const Eigen::FullPivLU<Eigen::MatrixXd> schur(e.transpose() * ce);
  if (schur.rank() < rigid) return false;  // too few contacts to carry the load: the set has to grow
  s.tangent = schur.inverse();
  s.rigid = s.tangent * (p.load + e.transpose() * cg);
  const Eigen::VectorXd f = ce * s.rigid - cg;
  s.force.setZero(p.gap.size());
  for (Eigen::Index i = 0; i < n; ++i) s.force[set[i]] = f[i];
  s.gap = p.compliance * s.force + p.gap - p.rigid * s.rigid;
  return true;
}

}  // namespace

ComplementaritySolution solve_complementarity(const ComplementarityProblem& problem, std::vector<bool> start) {
  const int n = static_cast<int>(problem.gap.size());
  ComplementaritySolution s;
  s.active = std::move(start);
  if (static_cast<int>(s.active.size()) != n) s.active.assign(n, true);
  for (int i = 0; i < n; ++i)
    if (!problem.unilateral[i]) s.active[i] = true;

  constexpr int most_blocks = 60;
  ContactTolerances zero(problem);
  for (s.iterations = 1; s.iterations <= most_blocks; ++s.iterations) {
    const auto set = indices_of(s.active);
    if (!solve_active(problem, set, s)) {
      if (static_cast<int>(set.size()) == n)
        throw SolverError(fmt::format("all {} contacts and supports together cannot carry the load", n));
      s.active.assign(n, true);
      continue;
    }
    zero.set_motion(s.rigid);
    std::vector<bool> next = s.active;
    for (int i = 0; i < n; ++i) {
      if (!problem.unilateral[i]) continue;
      if (s.active[i] ? s.force[i] < -zero.force(i) : s.gap[i] < -zero.gap()) next[i] = !s.active[i];
    }
    if (next == s.active) return s;
    s.active = std::move(next);
  }
  s.active = primal_active_set(problem);
  if (!solve_active(problem, indices_of(s.active), s))
    throw SolverError(fmt::format("{} of {} contacts and supports touch and leave the ring free to move",
                                  indices_of(s.active).size(), n));
  return s;
}

}  // namespace annulus::fem
