#include "fem/ring/ring_on_supports.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/errors.h"
#include "fem/contact/complementarity.h"

namespace annulus::fem {
namespace {

/// Compliance of loads on a floating ring whose supports keep touching. With the forces p of the supports and the
/// rigid motion x,
///
///     C p + U f + R_p x = 0,   R_p^T p + R_f^T f = 0,   u = F f + U^T p + R_f x
///
/// so that u = (F - U^T C^-1 U + Q S^-1 Q^T) f,  Q = R_f - U^T C^-1 R_p,  S = R_p^T C^-1 R_p.
Eigen::MatrixXd eliminate_supports(const Eigen::MatrixXd& F, const Eigen::MatrixXd& U, const Eigen::MatrixXd& C,
                                   const Eigen::MatrixX3d& R_f, const Eigen::MatrixX3d& R_p) {
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  if (factor.info() != Eigen::Success) {
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C, Eigen::EigenvaluesOnly).eigenvalues();
    throw SolverError(fmt::format(
        "the compliance of the {} supports of the ring is not positive definite: its eigenvalues lie between "
        "{:.4g} and {:.4g} m/N",
        C.rows(), values.minCoeff(), values.maxCoeff()));
  }
  const Eigen::MatrixXd u = factor.matrixL().solve(U);
  const Eigen::MatrixXd r = factor.matrixL().solve(R_p);
  const Eigen::MatrixXd Q = R_f - u.transpose() * r;
  const Eigen::LDLT<Eigen::MatrixXd> rigid(r.transpose() * r);
  constexpr double least_rcond = 1e-12;
  if (rigid.info() != Eigen::Success || rigid.rcond() < least_rcond)
    throw SolverError(fmt::format(
        "the {} supports that touch do not hold the ring: the reciprocal condition number of its rigid motion "
        "is {:.2g}, at least {:g} is needed; use more supports, or less play",
        C.rows(), rigid.rcond(), least_rcond));
  Eigen::MatrixXd result = F - u.transpose() * u + Q * rigid.solve(Q.transpose());
  return 0.5 * (result + result.transpose());
}

Eigen::MatrixX3d with_moment_over(double lever, const Eigen::Matrix3Xd& resultants) {
  Eigen::MatrixX3d result = resultants.transpose();
  result.col(2) /= lever;
  return result;
}

/// Resultants of some loads of all sectors.
Eigen::MatrixX3d all_resultants(const RingFlexibility& ring, int first, int count) {
  Eigen::Matrix3Xd result(3, ring.teeth * count);
  for (int s = 0; s < ring.teeth; ++s) result.middleCols(s * count, count) = ring.resultants_of(s, first, count);
  return with_moment_over(ring.base_radius, result);
}

/// Compliance between some loads of all sectors and some others.
Eigen::MatrixXd all_compliances(const RingFlexibility& ring, int first_row, int rows, int first_column, int columns) {
  Eigen::MatrixXd result(ring.teeth * rows, ring.teeth * columns);
  for (int s = 0; s < ring.teeth; ++s)
    for (int t = 0; t < ring.teeth; ++t)
      result.block(s * rows, t * columns, rows, columns) =
          ring.compliance.block(s - t).block(first_row, first_column, rows, columns);
  return result;
}

}  // namespace

RingOnSupports::RingOnSupports(const RingFlexibility& ring, const SupportPlan& plan)
    : ring_(ring), plan_(plan), compliance_(plan.own_compliance()) {
  const auto& forces = plan.forces();
  const auto n = static_cast<Eigen::Index>(forces.size());
  Eigen::Matrix3Xd resultants = Eigen::Matrix3Xd::Zero(3, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (const auto& [sector, arc] : forces[i].pieces) {
      resultants.col(i) += ring.resultants_of(sector, ring.first_arc() + arc, 1);
      for (Eigen::Index j = 0; j < n; ++j)
        for (const auto& [other, other_arc] : forces[j].pieces)
          compliance_(i, j) +=
              ring.compliance.block(sector - other)(ring.first_arc() + arc, ring.first_arc() + other_arc);
    }
  compliance_ = (0.5 * (compliance_ + compliance_.transpose())).eval();
  resultants_ = with_moment_over(ring.base_radius, resultants);
  teeth_coupling_ = coupling(0, 1);
}

bool RingOnSupports::unilateral() const {
  return std::any_of(plan_.forces().begin(), plan_.forces().end(),
                     [&](const auto& force) { return plan_.direction(force).unilateral; });
}

Eigen::MatrixXd RingOnSupports::coupling(int first, int count) const {
  const auto& forces = plan_.forces();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(forces.size()), ring_.teeth * count);
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (const auto& [sector, arc] : forces[i].pieces)
      for (int s = 0; s < ring_.teeth; ++s)
        result.block(static_cast<Eigen::Index>(i), s * count, 1, count) +=
            ring_.compliance.block(sector - s).block(ring_.first_arc() + arc, first, 1, count);
  return result;
}

RingOnSupports::State RingOnSupports::solve(const Eigen::MatrixXd& patterns, const Eigen::VectorXd& forces,
                                            std::vector<bool> start) const {
  const Eigen::MatrixXd F = patterns.transpose() * all_compliances(ring_, 0, 1, 0, 1) * patterns;
  const Eigen::MatrixXd U = teeth_coupling_ * patterns;
  const Eigen::MatrixX3d R_f = patterns.transpose() * all_resultants(ring_, 0, 1);
  const auto n = compliance_.rows();
  ComplementarityProblem problem;
  problem.compliance = compliance_;
  problem.gap = U * forces;
  problem.rigid = -resultants_;
  problem.load = R_f.transpose() * forces;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& direction = plan_.direction(plan_.forces()[i]);
    problem.gap[i] += direction.clearance;
    problem.unilateral.push_back(direction.unilateral);
  }
  const auto solution = solve_complementarity(problem, std::move(start));

  State state;
  state.displacement = F * forces + U.transpose() * solution.force + R_f * solution.rigid;
  state.touching = solution.active;
  state.support = solution.force;
  std::vector<Eigen::Index> touching;
  for (Eigen::Index i = 0; i < n; ++i)
    if (solution.active[i]) touching.push_back(i);
  const Eigen::MatrixXd U_t = U(touching, Eigen::all), C_t = compliance_(touching, touching);
  const Eigen::MatrixX3d R_t = resultants_(touching, Eigen::all);
  state.tangent = eliminate_supports(F, U_t, C_t, R_f, R_t);
  return state;
}

std::vector<Eigen::Index> RingOnSupports::held() const {
  std::vector<Eigen::Index> held;
  for (std::size_t i = 0; i < plan_.forces().size(); ++i)
    if (plan_.forces()[i].site < plan_.sites().pins) held.push_back(static_cast<Eigen::Index>(i));
  return held;
}

Eigen::MatrixXd RingOnSupports::held_teeth_compliance() const {
  const auto held = this->held();
  const Eigen::MatrixX3d R_h = resultants_(held, Eigen::all);
  return eliminate_supports(all_compliances(ring_, 0, 1, 0, 1), teeth_coupling_(held, Eigen::all),
                            compliance_(held, held), all_resultants(ring_, 0, 1), R_h);
}

Eigen::MatrixXd RingOnSupports::held_compliance() const {
  const auto held = this->held();
  const int motions = ring_.motions, first = ring_.first_motion();
  const Eigen::Index teeth = ring_.teeth, all = teeth * (1 + motions);
  Eigen::MatrixXd F(all, all);
  F.topLeftCorner(teeth, teeth) = all_compliances(ring_, 0, 1, 0, 1);
  F.bottomLeftCorner(all - teeth, teeth) = all_compliances(ring_, first, motions, 0, 1);
  F.topRightCorner(teeth, all - teeth) = F.bottomLeftCorner(all - teeth, teeth).transpose();
  F.bottomRightCorner(all - teeth, all - teeth) = all_compliances(ring_, first, motions, first, motions);
  Eigen::MatrixXd U(compliance_.rows(), all);
  U << teeth_coupling_, coupling(first, motions);
  Eigen::MatrixX3d R_f(all, 3);
  R_f << all_resultants(ring_, 0, 1), all_resultants(ring_, first, motions);
  const Eigen::MatrixXd U_h = U(held, Eigen::all), C_h = compliance_(held, held);
  const Eigen::MatrixX3d R_h = resultants_(held, Eigen::all);
  return eliminate_supports(F, U_h, C_h, R_f, R_h);
}

}  // namespace annulus::fem
