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
  const auto root = [](double k, const std::string& name) {
    if (!(k >= 0))
      throw SolverError(fmt::format("the stiffness is indefinite: {} has {} N/m, which must not be negative", name, k));
    return std::sqrt(k);
  };
  for (Eigen::Index i = 0; i < springs; ++i) {
    const auto& spring = system.springs()[static_cast<std::size_t>(i)];
    for (const auto& [dof, factor] : spring.a) rows(i, dof) += root(spring.stiffness, spring.name) * factor;
  }
  const Eigen::MatrixXd approach = system.mesh_vectors().transpose();
  if (system.couplings().empty()) {
    for (Eigen::Index m = 0; m < meshes; ++m)
      rows.row(springs + m) =
          root(mesh_stiffness[m], system.meshes()[static_cast<std::size_t>(m)].name) * approach.row(m);
    return rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> coupled(mesh_stiffness_matrix(system, mesh_stiffness));
  if (coupled.info() != Eigen::Success)
    throw SolverError(fmt::format("the stiffness matrix of {} coupled meshes has no eigenvalues", meshes));
  for (Eigen::Index m = 0; m < meshes; ++m)
    rows.row(springs + m) =
        root(coupled.eigenvalues()[m], "a coupling of meshes") * coupled.eigenvectors().col(m).transpose() * approach;
  return rows;
}

Eigen::VectorXd of_meshes(const LumpedSystem& system, double (*stiffness)(const MeshExcitation&)) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(system.meshes().size()));
  for (Eigen::Index m = 0; m < result.size(); ++m) result[m] = stiffness(system.meshes()[m].excitation);
  return result;
}

}  // namespace

Eigen::VectorXd mean_stiffnesses(const LumpedSystem& system) { return of_meshes(system, mean_stiffness); }
Eigen::VectorXd mean_tangents(const LumpedSystem& system) { return of_meshes(system, mean_tangent_stiffness); }

Eigen::MatrixXd Modes::shapes() const {
  const auto n = static_cast<Eigen::Index>(modes.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) result.col(i) = modes[i].shape;
  return result;
}

Eigen::MatrixXd mesh_stiffness_matrix(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  require(mesh_stiffness.size() == static_cast<Eigen::Index>(system.meshes().size()),
          fmt::format("{} stiffnesses for {} meshes", mesh_stiffness.size(), system.meshes().size()));
  Eigen::MatrixXd result = mesh_stiffness.asDiagonal();
  for (const auto& coupling : system.couplings()) {
    const auto n = static_cast<Eigen::Index>(coupling.meshes.size());
    const auto& first = system.meshes()[coupling.meshes.front()];
    Eigen::MatrixXd compliance(n, n);
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j, ++k) {
        const auto& curve = coupling.compliance[k];
        double value = coupling.retained.empty() ? curve.mean() : curve(first.phase_offset);
        for (const auto& retained : coupling.retained)
          value -= system.mesh_vector(coupling.meshes[i])[retained.dof] *
                   system.mesh_vector(coupling.meshes[j])[retained.dof] / retained.stiffness;
        compliance(i, j) = compliance(j, i) = value;
      }
    // (1/k + c)^-1 = s (1 + s c s)^-1 s with s = sqrt(k): also where a mesh has no stiffness.
    Eigen::VectorXd root(n);
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(mesh_stiffness[coupling.meshes[i]]);
    const Eigen::MatrixXd scaled = root.asDiagonal() * compliance * root.asDiagonal();
    const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(n, n) + scaled);
    if (factor.info() != Eigen::Success)
      throw SolverError(
          fmt::format("the coupling of {} meshes (the first: {}) subtracts more compliance than they have. Its elastic "
                      "modes were computed with supports that hold in both directions; they are not valid for a body "
                      "that lifts off many supports",
                      n, first.name));
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
  // The frequencies are the singular values of sqrt(k) a^T L^-T, one row per spring and mesh, M = L L^T. Their rounding
  // error is 1e-16 of the highest frequency. Eigenvalues of K would have that share of the highest square, and soft
  // supports beside stiff ones would be lost.
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  const Eigen::MatrixXd rows = stiffness_rows(system, mesh_stiffness);
  const Eigen::JacobiSVD<Eigen::MatrixXd> solver(mass.matrixL().solve(rows.transpose()).transpose(),
                                                 Eigen::ComputeThinV);
  const Eigen::VectorXd& rates = solver.singularValues();
  if (!rates.allFinite())
    throw SolverError(
        fmt::format("the natural frequencies of {} degrees of freedom are not finite; the first is {} rad/s",
                    system.dofs(), rates[0]));
  // 1e-15 times the DOFs; below 1e-13 frequencies are zero.
  const double zero = 1e-13 * rates[0];
  for (Eigen::Index i = rates.size() - 1; i >= 0; --i) {
    Mode mode;
    mode.frequency = rates[i] <= zero ? 0.0 : rates[i] / (2 * std::numbers::pi);
    mode.shape = mass.matrixU().solve(solver.matrixV().col(i));
    result.modes.push_back(std::move(mode));
  }
  return result;
}

Modes modes(const LumpedSystem& system) { return modes(system, mean_tangents(system)); }

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
  throw InputError(fmt::format(
      "the load is not balanced: no support resists it at {}; give that body, or one coupled to it, a support",
      system.names()[static_cast<std::size_t>(most)]));
}

}  // namespace annulus::dynamics
