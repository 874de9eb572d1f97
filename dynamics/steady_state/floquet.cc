#include "dynamics/steady_state/floquet.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/errors.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

double growth_per_cycle(const LumpedSystem& system, double mesh_frequency, const ResponseWindow& window) {
  const Eigen::Index n = system.dofs();
  require(window.samples_per_cycle > 0 && window.displacement.cols() >= window.samples_per_cycle,
          fmt::format("a window of {} samples must hold a mesh cycle of {}", window.displacement.cols(),
                      window.samples_per_cycle));
  const Eigen::MatrixXd b = system.mesh_vectors(), fixed = system.stiffness() + system.rotating_stiffness();
  Eigen::VectorXd mean(b.cols());
  for (Eigen::Index m = 0; m < mean.size(); ++m) mean[m] = mean_stiffness(system.meshes()[m].excitation);
  const Modes found = modes(system, mean);
  Eigen::MatrixXd shapes(n, n);
  for (Eigen::Index i = 0; i < n; ++i) shapes.col(i) = found.modes[i].shape;
  // Rigid displacements act on nothing. Included, they would make a multiplier of one defective, which rounding splits
  // by its root.
  const Eigen::Index free = neutral_motions(found, fixed + b * mean.asDiagonal() * b.transpose(), system.mass());
  const Eigen::Index elastic = n - free;
  const auto bent = shapes.rightCols(elastic);
  const double w = std::max(2 * std::numbers::pi * found.modes.back().frequency, mesh_frequency);
  // Elastic displacements and all velocities / w: entries of like size.
  Eigen::MatrixXd tangent(b.cols(), b.cols()), state = Eigen::MatrixXd::Zero(elastic + n, elastic + n),
                                               map = Eigen::MatrixXd::Identity(elastic + n, elastic + n);
  state.topRightCorner(elastic, elastic).setIdentity();
  state.bottomRightCorner(n, n) =
      -shapes.transpose() * (system.damping_with_meshes() + system.gyroscopic()) * shapes / w;
  auto workspace = system.workspace();
  for (int i = 0; i < window.samples_per_cycle; ++i) {
    const Eigen::VectorXd q = window.displacement.col(i), v = window.velocity.col(i);
    system.detect_contact(window.time[i], q.data(), workspace);
    system.evaluate_meshes(window.time[i], q.data(), v.data(), workspace);
    system.tangent_matrix(workspace, tangent);
    state.bottomLeftCorner(n, elastic) = -shapes.transpose() * (fixed + b * tangent * b.transpose()) * bent / (w * w);
    map = (state * (w / (mesh_frequency * window.samples_per_cycle))).exp() * map;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(map, false);
  if (solver.info() != Eigen::Success)
    throw SolverError(fmt::format("the Floquet multipliers of {} state variables were not found", map.rows()));
  const double growth = solver.eigenvalues().cwiseAbs().maxCoeff();
  const double rounding = 100 * std::numeric_limits<double>::epsilon() * (1 + w / mesh_frequency);
  return growth <= 1 + rounding ? std::min(growth, 1.0) : growth;
}

}  // namespace annulus::dynamics
