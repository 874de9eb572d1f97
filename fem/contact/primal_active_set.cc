#include "fem/contact/primal_active_set.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Forces f >= 0 (of any sign where held both ways) with E^T f = t, few of them: non-negative least squares
/// [LawsonHanson1974], forces held both ways taken apart into push and pull. None where the load is out of reach.
std::optional<Eigen::VectorXd> carrying_forces(const ComplementarityProblem& p) {
  const Eigen::Index n = p.gap.size();
  std::vector<std::pair<Eigen::Index, double>> columns;  // force and sign
  for (Eigen::Index i = 0; i < n; ++i) {
    columns.emplace_back(i, 1.0);
    if (!p.unilateral[i]) columns.emplace_back(i, -1.0);
  }
  const auto m = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd a(p.rigid.cols(), m);
  for (Eigen::Index j = 0; j < m; ++j) a.col(j) = columns[j].second * p.rigid.row(columns[j].first).transpose();
  const double scale = p.load.norm(), negligible = 1e-12 * scale;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(m);
  std::vector<Eigen::Index> passive;
  for (Eigen::Index step = 0; step <= 3 * m; ++step) {
    const Eigen::VectorXd residual = p.load - a * x;
    if (residual.norm() <= negligible) {
      Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
      for (Eigen::Index j = 0; j < m; ++j) force[columns[j].first] += columns[j].second * x[j];
      return force;
    }
    Eigen::VectorXd descent = a.transpose() * residual;
    for (const Eigen::Index j : passive) descent[j] = 0;
    Eigen::Index enters = 0;
    if (!(descent.maxCoeff(&enters) > negligible * 1e-3)) return std::nullopt;
    passive.push_back(enters);
    for (;;) {
      const Eigen::VectorXd z = a(Eigen::all, passive).colPivHouseholderQr().solve(p.load);
      double part = 1;
      for (std::size_t k = 0; k < passive.size(); ++k)
        if (z[k] <= 0) part = x[passive[k]] > 0 ? std::min(part, x[passive[k]] / (x[passive[k]] - z[k])) : 0;
      for (std::size_t k = 0; k < passive.size(); ++k) x[passive[k]] += part * (z[k] - x[passive[k]]);
      if (part == 1) break;
      std::vector<Eigen::Index> stay;
      for (const Eigen::Index j : passive) {
        if (x[j] > 1e-14 * scale)
          stay.push_back(j);
        else
          x[j] = 0;
      }
      passive = std::move(stay);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<int> indices_of(const std::vector<bool>& active) {
  std::vector<int> set;
  for (int i = 0; i < static_cast<int>(active.size()); ++i)
    if (active[i]) set.push_back(i);
  return set;
}

std::vector<bool> primal_active_set(const ComplementarityProblem& p) {
  ContactTolerances zero(p);
  const Eigen::Index n = p.gap.size(), rigid = p.rigid.cols();
  const auto start = carrying_forces(p);
  if (!start) throw SolverError(fmt::format("all {} contacts and supports together cannot carry the load", n));
  Eigen::VectorXd force = *start;
  std::vector<bool> active(n);
  for (Eigen::Index i = 0; i < n; ++i) active[i] = !p.unilateral[i] || force[i] > 0;
  const int most = 200 + 20 * static_cast<int>(n);
  for (int step = 0; step < most; ++step) {
    // Forces in equilibrium on the set, and the motions that close its gaps; the least ones where it leaves some free.
    const std::vector<int> set = indices_of(active);
    const auto m = static_cast<Eigen::Index>(set.size());
    const double stiff = p.compliance.diagonal().mean();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(m + rigid, m + rigid);
    system.topLeftCorner(m, m) = p.compliance(set, set) / stiff;
    system.topRightCorner(m, rigid) = -p.rigid(set, Eigen::all);
    system.bottomLeftCorner(rigid, m) = p.rigid(set, Eigen::all).transpose();
    Eigen::VectorXd right(m + rigid);
    right << -p.gap(set) / stiff, p.load;
    const Eigen::VectorXd solved = system.completeOrthogonalDecomposition().solve(right);
    zero.set_motion(stiff * solved.tail(rigid));
    double part = 1;
    for (Eigen::Index k = 0; k < m; ++k)
      if (p.unilateral[set[k]] && solved[k] < -zero.force(set[k]))
        part = std::min(part, std::max(0.0, force[set[k]]) / (std::max(0.0, force[set[k]]) - solved[k]));
    for (Eigen::Index k = 0; k < m; ++k) force[set[k]] += part * (solved[k] - force[set[k]]);
    if (part < 1) {
      for (Eigen::Index k = 0; k < m; ++k) {
        const int i = set[k];
        if (!p.unilateral[i] || solved[k] >= -zero.force(i) || force[i] > zero.force(i)) continue;
        active[i] = false;
        force[i] = 0;
      }
      continue;
    }
    const Eigen::VectorXd gap = p.compliance * force + p.gap - stiff * (p.rigid * solved.tail(rigid));
    int enters = -1;
    double least = -zero.gap();
    for (Eigen::Index i = 0; i < n; ++i)
      if (!active[i] && gap[i] < least) least = gap[i], enters = static_cast<int>(i);
    if (enters < 0) return active;
    active[enters] = true;
  }
  throw SolverError(fmt::format("the set of {} contacts did not settle in {} exchanges", n, most));
}

}  // namespace annulus::fem
