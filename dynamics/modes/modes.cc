#include "dynamics/modes/modes.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// sqrt(k) a^T of every spring and mesh, at least as many rows as DOFs: K = rows^T rows.
Eigen::MatrixXd stiffness_rows(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  const auto springs = static_cast<Eigen::Index>(system.springs().size());
  const Eigen::Index n = system.dofs(), meshes = mesh_stiffness.size();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::max(springs + meshes, n), n);
  const auto root = [](double k) {
    if (!(k >= 0)) throw SolverError("the stiffness is indefinite: a support or mesh stiffness is negative");
    return std::sqrt(k);
  };
  for (Eigen::Index i = 0; i < springs; ++i) {
    const auto& spring = system.springs()[static_cast<std::size_t>(i)];
    for (const auto& [dof, factor] : spring.a) rows(i, dof) += root(spring.stiffness) * factor;
  }
  const Eigen::MatrixXd closing = system.mesh_vectors().transpose();
  if (system.couplings().empty()) {
    for (Eigen::Index m = 0; m < meshes; ++m) rows.row(springs + m) = root(mesh_stiffness[m]) * closing.row(m);
    return rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> coupled(mesh_stiffness_matrix(system, mesh_stiffness));
  if (coupled.info() != Eigen::Success) throw SolverError("the stiffness of the coupled meshes has no square root");
  for (Eigen::Index m = 0; m < meshes; ++m)
    rows.row(springs + m) = root(coupled.eigenvalues()[m]) * coupled.eigenvectors().col(m).transpose() * closing;
  return rows;
}

}  // namespace

Eigen::MatrixXd mesh_stiffness_matrix(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  require(mesh_stiffness.size() == static_cast<Eigen::Index>(system.meshes().size()), "one stiffness per mesh");
  Eigen::MatrixXd result = mesh_stiffness.asDiagonal();
  for (const auto& coupling : system.couplings()) {
    const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
    const auto& first = system.meshes()[coupling.meshes.front()];
    Eigen::MatrixXd compliance(n, n);
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j, ++k) {
        const auto& curve = coupling.compliance[k];
        double value = coupling.kept.empty() ? curve.mean() : curve(first.phase_offset);
        for (const auto& kept : coupling.kept)
          value -= system.mesh_vector(coupling.meshes[i])[kept.dof] * system.mesh_vector(coupling.meshes[j])[kept.dof] /
                   kept.stiffness;
        compliance(i, j) = compliance(j, i) = value;
      }
    // (1/k + c)^-1 = s (1 + s c s)^-1 s with s = sqrt(k): also where a mesh has no stiffness.
    Eigen::VectorXd root(n);
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(mesh_stiffness[coupling.meshes[i]]);
    const Eigen::MatrixXd scaled = root.asDiagonal() * compliance * root.asDiagonal();
    const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(n, n) + scaled);
    if (factor.info() != Eigen::Success)
      throw SolverError(
          "the coupling through the ring takes more compliance off its meshes than they have: its elastic modes belong "
          "to supports held both ways and do not fit a ring that lifts off so much of them");
    const Eigen::MatrixXd stiffness =
        root.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(n, n)) * root.asDiagonal();
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        result(coupling.meshes[i], coupling.meshes[j]) = (stiffness(i, j) + stiffness(j, i)) / 2;
  }
  return result;
}

Eigen::MatrixXd stiffness_with_meshes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  const Eigen::MatrixXd b = system.mesh_vectors();
  return system.stiffness() + b * mesh_stiffness_matrix(system, mesh_stiffness) * b.transpose();
}

Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  Modes result;
  result.dofs = system.names();
  if (system.dofs() == 0) return result;
  // The frequencies are the singular values of sqrt(k) a^T L^-T, one row per spring and mesh, M = L L^T. Rounding
  // leaves 1e-16 of the highest frequency of them; of the eigenvalues of K it would leave that share of the highest
  // square, and soft supports beside stiff ones would be lost.
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  const Eigen::MatrixXd rows = stiffness_rows(system, mesh_stiffness);
  const Eigen::JacobiSVD<Eigen::MatrixXd> solver(mass.matrixL().solve(rows.transpose()).transpose(),
                                                 Eigen::ComputeThinV);
  const Eigen::VectorXd& rates = solver.singularValues();
  if (!rates.allFinite()) throw SolverError("the natural frequencies are not finite numbers");
  // 1e-15 times the DOFs; below 1e-13 nothing is known but zero.
  const double zero = 1e-13 * rates[0];
  for (Eigen::Index i = rates.size() - 1; i >= 0; --i) {
    Mode mode;
    mode.frequency = rates[i] <= zero ? 0.0 : rates[i] / (2 * std::numbers::pi);
    mode.shape = mass.matrixU().solve(solver.matrixV().col(i));
    result.modes.push_back(std::move(mode));
  }
  return result;
}

bool costs_no_force(const Eigen::VectorXd& shape, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  constexpr double rounding = 1e-11, noise = 1e-2;  // rounding x noise: what a shape's zeros are, of the whole shape
  const Eigen::VectorXd size = shape.cwiseAbs().cwiseMax(noise * mass.diagonal().cwiseSqrt().cwiseInverse());
  const auto vanishes = [&](const Eigen::MatrixXd& k) {
    return ((k * shape).array().abs() <= rounding * (k.cwiseAbs() * size).array()).all();
  };
  return vanishes(stiffness) && vanishes(stiffness.transpose());
}

Eigen::Index neutral_motions(const Modes& found, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  Eigen::Index count = 0;
  for (const auto& mode : found.modes) {
    if (mode.frequency > 0) break;
    if (!costs_no_force(mode.shape, stiffness, mass)) return 0;
    ++count;
  }
  return count;
}

void refuse_unbalanced(const LumpedSystem& system, const Eigen::VectorXd& shape) {
  Eigen::Index most = 0;
  shape.cwiseProduct(system.load()).cwiseAbs().maxCoeff(&most);
  throw InputError(
      fmt::format("the load is not balanced: nothing holds {} against it; give it (or what it is coupled to) a support",
                  system.names()[static_cast<std::size_t>(most)]));
}

}  // namespace annulus::dynamics
