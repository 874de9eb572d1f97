#include "dynamics/floquet.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/errors.h"

namespace annulus::dynamics {

double growth_per_cycle(const LumpedSystem& system, double mesh_frequency, const ResponseWindow& window) {
  const Eigen::Index n = system.freedoms(), meshes = static_cast<Eigen::Index>(system.meshes().size());
  require(window.samples_per_cycle > 0 && window.displacement.cols() >= window.samples_per_cycle,
          "a window of a motion holds a mesh cycle");
  Eigen::MatrixXd b(n, meshes), damping = system.damping() + system.gyroscopic();
  for (Eigen::Index m = 0; m < meshes; ++m) {
    b.col(m) = system.mesh_vector(static_cast<int>(m));
    damping += system.meshes()[m].damping * b.col(m) * b.col(m).transpose();
  }
  // In L^T q, M = L L^T, and velocities / w: entries of like size.
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  const auto reduced = [&](const Eigen::MatrixXd& matrix) {
    const Eigen::MatrixXd left = mass.matrixL().solve(matrix);
    return Eigen::MatrixXd(mass.matrixL().solve(left.transpose()).transpose());
  };
  const Eigen::MatrixXd fixed = reduced(system.stiffness() + system.rotating_stiffness()),
                        shaken = mass.matrixL().solve(b);
  auto workspace = system.workspace();
  Eigen::MatrixXd tangent(meshes, meshes), state = Eigen::MatrixXd::Zero(2 * n, 2 * n),
                                           map = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  double w = 0;
  for (int i = 0; i < window.samples_per_cycle; ++i) {
    const Eigen::VectorXd q = window.displacement.col(i), v = window.velocity.col(i);
    system.detect_contact(window.time[i], q.data(), workspace);
    system.evaluate_meshes(window.time[i], q.data(), v.data(), workspace);
    system.tangent_matrix(workspace, tangent);
    const Eigen::MatrixXd stiffness = fixed + shaken * tangent * shaken.transpose();
    if (w == 0) {
      w = std::sqrt(std::max(stiffness.cwiseAbs().maxCoeff(), 1e-300));
      state.topRightCorner(n, n).setIdentity();
      state.bottomRightCorner(n, n) = -reduced(damping) / w;
    }
    state.bottomLeftCorner(n, n) = -stiffness / (w * w);
    map = (state * (w / (mesh_frequency * window.samples_per_cycle))).exp() * map;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(map, false);
  if (solver.info() != Eigen::Success) throw SolverError("the Floquet multipliers were not found");
  const double growth = solver.eigenvalues().cwiseAbs().maxCoeff();
  // Rigid motions are double multipliers of one, which rounding of a map of this norm parts by its root.
  const double rounding = 10 * std::sqrt(std::numeric_limits<double>::epsilon() * (1 + w / mesh_frequency));
  return growth <= 1 + rounding ? std::min(growth, 1.0) : growth;
}

}  // namespace annulus::dynamics
