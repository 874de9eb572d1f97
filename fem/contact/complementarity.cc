#include "fem/contact/complementarity.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Equality-constrained solve on the active set.
bool solve_active(const ComplementarityProblem& p, const std::vector<int>& set, ComplementaritySolution& s) {
  const auto n = static_cast<Eigen::Index>(set.size());
  const auto rigid = p.rigid.cols();
  Eigen::MatrixXd c(n, n), e(n, rigid);
  Eigen::VectorXd g(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) c(i, j) = p.compliance(set[i], set[j]);
    e.row(i) = p.rigid.row(set[i]);
    g[i] = p.gap[set[i]];
  }
  if (!lapack::cholesky(c)) throw SolverError("the contact compliance is not positive definite");
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
  const int most = most_blocks + 20 * n;
  // Gaps below round-off of the largest elastic deflection are closed.
  const double scale = problem.compliance.diagonal().maxCoeff() * problem.load.cwiseAbs().maxCoeff();
  const double gap_tolerance = 1e-13 * scale, force_tolerance = 1e-13 * problem.load.cwiseAbs().maxCoeff();
  for (s.iterations = 1; s.iterations <= most; ++s.iterations) {
    std::vector<int> set;
    for (int i = 0; i < n; ++i)
      if (s.active[i]) set.push_back(i);
    if (!solve_active(problem, set, s)) {
      s.active.assign(n, true);
      if (static_cast<int>(set.size()) == n) throw SolverError("the contacts and supports cannot carry the load");
      continue;
    }
    int worst = -1;
    double worst_violation = 0;
    std::vector<bool> next = s.active;
    for (int i = 0; i < n; ++i) {
      if (!problem.unilateral[i]) continue;
      double violation = 0;
      if (s.active[i] && s.force[i] < -force_tolerance)
        violation = -s.force[i] * problem.compliance(i, i);
      else if (!s.active[i] && s.gap[i] < -gap_tolerance)
        violation = -s.gap[i];
      if (violation == 0) continue;
      next[i] = !s.active[i];
      if (violation > worst_violation) worst_violation = violation, worst = i;
    }
    if (worst < 0) return s;
    if (s.iterations < most_blocks)
      s.active = std::move(next);
    else
      s.active[worst] = !s.active[worst];
  }
  throw SolverError("the contact set did not settle in " + std::to_string(most) + " exchanges");
}

}  // namespace annulus::fem
