#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/lumped_system_compiled.h"

namespace annulus::dynamics {

namespace {

using ConstCompliance = Eigen::Map<const Eigen::MatrixXd>;

ConstCompliance compliance_of(const CompiledCoupling& coupling, const LumpedSystem::Workspace& w) {
  const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
  return {w.compliance.data() + coupling.offset, n, n};
}

double factor_of(int share, const std::vector<double>& factors) { return share < 0 ? 0.0 : factors[share]; }

}  // namespace

std::vector<PeriodicCurve> compliance_curves(const std::vector<Eigen::MatrixXd>& matrices, int per_cycle) {
  if (matrices.empty())
    throw InputError(
        fmt::format("a mesh coupling needs at least one compliance matrix for {} positions per mesh cycle", per_cycle));
  std::vector<PeriodicCurve> curves;
  for (Eigen::Index i = 0; i < matrices.front().rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      std::vector<double> values;
      values.reserve(matrices.size());
      for (const auto& matrix : matrices) values.push_back(matrix(i, j));
      curves.emplace_back(values, per_cycle);
    }
  return curves;
}

void evaluate_compliance(const CompiledCoupling& coupling, double t, LumpedSystem::Workspace& w) {
  const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
  Eigen::Map<Eigen::MatrixXd> d(w.compliance.data() + coupling.offset, n, n);
  const auto& bundle = coupling.compliance;
  const auto [index, x] = bundle.grid().locate(coupling.frequency * t + coupling.phase_offset);
  const int width = bundle.width();
  const double *c0 = bundle.piece(index), *c1 = c0 + width, *c2 = c1 + width, *c3 = c2 + width;
  int k = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++k) {
      double value = c0[k] + x * (c1[k] + x * (c2[k] + x * c3[k]));
      for (const auto& retained : coupling.retained)
        value -=
            retained.compliance * factor_of(retained.shares[i], w.factor) * factor_of(retained.shares[j], w.factor);
      d(i, j) = d(j, i) = value;
    }
}

CouplingMatrix compliance_rate(const CompiledCoupling& coupling, double t, const LumpedSystem::Workspace& w) {
  const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
  constexpr int entries = largest_coupling * (largest_coupling + 1) / 2;
  double values[entries], rates[entries];
  coupling.compliance.evaluate(coupling.frequency * t + coupling.phase_offset, values, rates);
  CouplingMatrix d(n, n);
  int k = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++k) {
      double rate = coupling.frequency * rates[k];
      for (const auto& retained : coupling.retained)
        rate -= retained.compliance *
                (factor_of(retained.shares[i], w.factor_rate) * factor_of(retained.shares[j], w.factor) +
                 factor_of(retained.shares[i], w.factor) * factor_of(retained.shares[j], w.factor_rate));
      d(i, j) = d(j, i) = rate;
    }
  return d;
}

// F = law(approach - D F) by Newton's method: (I + K D) dF = law - F with K the tangents of the laws. Laws rise and
// 1/K + D is positive on the closed meshes, so there is one solution. From the forces of the last evaluation held
// linear meshes take one step and laws two or three. Where contact states follow, the equations have kinks and full
// steps may cycle between states: after some the steps are shortened.
void solve_coupling(const CompiledCoupling& coupling, const std::vector<CompiledMesh>& meshes,
                    const std::vector<FaceElement>& faces, LumpedSystem::ContactStates states,
                    LumpedSystem::Workspace& w) {
  constexpr int steps = 80, full_steps = 20;
  constexpr double accuracy = 1e-13, shortened = 0.7;
  const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
  const auto d = compliance_of(coupling, w);
  CouplingVector force(n), residual(n), given(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double last = w.elastic[coupling.meshes[i]];
    force[i] = std::isfinite(last) ? last : 0.0;
  }
  for (int step = 0; step < steps; ++step) {
    given.noalias() = d * force;
    double scale = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto m = static_cast<std::size_t>(coupling.meshes[i]);
      w.delta[m] = w.approach[m] - given[i];
      if (meshes[m].face >= 0) {
        double across = 0;
        apply_face(faces[static_cast<std::size_t>(meshes[m].face)], meshes[m], w, across);
      } else {
        if (states == LumpedSystem::ContactStates::following) w.contact[m] = contact_of(meshes[m], w.delta[m]);
        apply_law(meshes[m], m, w);
      }
      residual[i] = w.elastic[m] - force[i];
      scale = std::max({scale, std::abs(w.elastic[m]), w.stiffness[m] * std::abs(w.approach[m])});
    }
    if (residual.cwiseAbs().maxCoeff() <= accuracy * scale) return;
    CouplingMatrix matrix = d;
    for (Eigen::Index i = 0; i < n; ++i) matrix.row(i) *= w.tangent[coupling.meshes[i]];
    matrix.diagonal().array() += 1;
    force += (step < full_steps ? 1.0 : shortened) * matrix.partialPivLu().solve(residual);
  }
  for (const int m : coupling.meshes) w.elastic[m] = not_known;
}

CouplingMatrix coupled_tangent(const CompiledCoupling& coupling, const LumpedSystem::Workspace& w) {
  const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
  CouplingMatrix matrix = compliance_of(coupling, w), tangents = CouplingMatrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    tangents(i, i) = w.tangent[coupling.meshes[i]];
    matrix.row(i) *= tangents(i, i);
  }
  matrix.diagonal().array() += 1;
  const CouplingMatrix tangent = matrix.partialPivLu().solve(tangents);
  return 0.5 * (tangent + tangent.transpose());  // symmetric up to rounding
}

}  // namespace annulus::dynamics
