#include "dynamics/modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Turns the shapes of every multiple frequency so that each is of one kind.
void separate_multiples(const KindSorter& sorter, std::vector<Mode>& modes) {
  for (std::size_t begin = 0, end = 0; begin < modes.size(); begin = end) {
    // Rounding parts equal frequencies by 1e-16 of the highest square over the square; different kinds that close are
    // one for every purpose.
    constexpr double same = 1e-9;
    for (end = begin + 1; end < modes.size(); ++end)
      if (modes[end].frequency - modes[begin].frequency > same * modes[end].frequency) break;
    if (end - begin == 1) continue;
    Eigen::MatrixXd shapes(modes[begin].shape.size(), static_cast<Eigen::Index>(end - begin));
    for (std::size_t i = begin; i < end; ++i) shapes.col(static_cast<Eigen::Index>(i - begin)) = modes[i].shape;
    shapes = sorter.separated(shapes);
    for (std::size_t i = begin; i < end; ++i) modes[i].shape = shapes.col(static_cast<Eigen::Index>(i - begin));
  }
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
          value -= system.mesh_vector(coupling.meshes[i])[kept.freedom] *
                   system.mesh_vector(coupling.meshes[j])[kept.freedom] / kept.stiffness;
        compliance(i, j) = compliance(j, i) = value;
      }
    for (Eigen::Index i = 0; i < n; ++i) compliance(i, i) += 1 / mesh_stiffness[coupling.meshes[i]];
    const Eigen::LLT<Eigen::MatrixXd> factor(compliance);
    if (factor.info() != Eigen::Success)
      throw SolverError(
          "the coupling through the ring takes more compliance off its meshes than they have: its elastic modes belong "
          "to supports held both ways and do not fit a ring that lifts off so much of them");
    const Eigen::MatrixXd stiffness = factor.solve(Eigen::MatrixXd::Identity(n, n));
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        result(coupling.meshes[i], coupling.meshes[j]) = (stiffness(i, j) + stiffness(j, i)) / 2;
  }
  return result;
}

Eigen::MatrixXd stiffness_with_meshes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  Eigen::MatrixXd b(system.freedoms(), mesh_stiffness.size());
  for (int m = 0; m < mesh_stiffness.size(); ++m) b.col(m) = system.mesh_vector(m);
  return system.stiffness() + b * mesh_stiffness_matrix(system, mesh_stiffness) * b.transpose();
}

Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  Modes result;
  result.freedoms = system.names();
  if (system.freedoms() == 0) return result;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness_with_meshes(system, mesh_stiffness),
                                                                         system.mass());
  if (solver.info() != Eigen::Success) throw SolverError("the eigenvalue solver for the natural frequencies failed");
  const auto& squares = solver.eigenvalues();
  // Rounding leaves squares of about 1e-16 x the largest (times the freedoms): below 1e-12 nothing is known but zero.
  const double zero = 1e-12 * squares.cwiseAbs().maxCoeff();
  for (int i = 0; i < squares.size(); ++i) {
    if (squares[i] < -zero) throw SolverError("the stiffness is indefinite: a support or mesh stiffness is negative");
    Mode mode;
    mode.frequency = squares[i] <= zero ? 0.0 : std::sqrt(squares[i]) / (2 * std::numbers::pi);
    mode.shape = solver.eigenvectors().col(i);
    result.modes.push_back(std::move(mode));
  }
  return result;
}

Eigen::VectorXd mean_mesh_stiffness(const PlanetaryStage& stage) {
  Eigen::VectorXd stiffness(2 * stage.planets());
  stiffness.head(stage.planets()).setConstant(mean_tangent_stiffness(stage.sun_mesh));
  stiffness.tail(stage.planets()).setConstant(mean_tangent_stiffness(stage.ring_mesh));
  return stiffness;
}

Modes modes(const PlanetaryStage& stage) {
  const LumpedSystem system = assemble(stage);
  Modes result = modes(system, mean_mesh_stiffness(stage));
  const KindSorter sorter(system, stage.planets());
  separate_multiples(sorter, result.modes);
  for (auto& mode : result.modes) mode.kind = sorter(mode.shape);
  return result;
}

}  // namespace annulus::dynamics
