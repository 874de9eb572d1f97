#include "dynamics/systems/planetary/load_sharing.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"

namespace annulus::dynamics {

namespace {

double largest_share(const Eigen::Ref<const Eigen::VectorXd>& force) {
  const double sum = force.sum();
  return sum > 0 ? static_cast<double>(force.size()) * force.maxCoeff() / sum : std::numeric_limits<double>::infinity();
}

}  // namespace

double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  require(force.size() > 0, fmt::format("load sharing of {} planets at {} times", force.rows(), force.cols()));
  double largest = 0;
  for (Eigen::Index i = 0; i < force.cols(); ++i) largest = std::max(largest, largest_share(force.col(i)));
  return largest;
}

double load_sharing_averaged(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle) {
  require(samples_per_cycle > 0 && force.cols() >= samples_per_cycle,
          fmt::format("load sharing over {} samples needs a mesh cycle of {}", force.cols(), samples_per_cycle));
  // Sum over the sliding cycle; sliding accumulates rounding of about columns x eps, far below any use.
  Eigen::VectorXd sum = force.leftCols(samples_per_cycle).rowwise().sum();
  double largest = largest_share(sum);
  for (Eigen::Index i = samples_per_cycle; i < force.cols(); ++i) {
    sum += force.col(i) - force.col(i - samples_per_cycle);
    largest = std::max(largest, largest_share(sum));
  }
  return largest;
}

Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  Eigen::MatrixXd share = force * static_cast<double>(force.rows());
  for (Eigen::Index i = 0; i < force.cols(); ++i) share.col(i) /= force.col(i).sum();
  return share;
}

QuasiStatic quasi_static(const PlanetaryStage& stage, int positions_per_cycle, int max_cycles) {
  if (positions_per_cycle < 1 || max_cycles < 1)
    throw InputError(fmt::format("quasi-static analysis needs at least one position and one mesh cycle, not {} and {}",
                                 positions_per_cycle, max_cycles));
  if (!(stage.carrier_speed > 0))
    throw InputError(fmt::format(
        "quasi-static positions follow from the carrier speed, {} rad/s, which must be positive", stage.carrier_speed));
  const LumpedSystem system = assemble(stage);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const int n = stage.planets();
  const int positions = positions_per_cycle * std::min(stage.error_period(), max_cycles);
  QuasiStatic result{Eigen::MatrixXd(n, positions), Eigen::MatrixXd(n, positions)};
  for (int i = 0; i < positions; ++i) {
    (void)solver.solve(i / (positions_per_cycle * stage.mesh_frequency()), workspace);
    for (int p = 0; p < n; ++p) {
      result.sun_force(p, i) = workspace.force[p];
      result.ring_force(p, i) = workspace.force[n + p];
    }
  }
  return result;
}

}  // namespace annulus::dynamics
