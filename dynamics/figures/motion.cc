#include "dynamics/figures/motion.h"

#include <algorithm>
#include <cmath>

namespace annulus::dynamics {

Eigen::MatrixXd deflections(const LumpedSystem& system, const Eigen::VectorXd& time,
                            const Eigen::MatrixXd& displacement) {
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  Eigen::MatrixXd result(meshes, time.size());
  auto workspace = system.workspace();
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    system.detect_contact(time[i], displacement.col(i).data(), workspace);
    result.col(i) = Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), meshes);
  }
  return result;
}

Eigen::MatrixXd accelerations(const LumpedSystem& system, const Eigen::VectorXd& time,
                              const Eigen::MatrixXd& displacement, const Eigen::MatrixXd& velocity) {
  const int n = system.dofs();
  auto workspace = system.workspace();
  Eigen::VectorXd state(2 * n), rate(2 * n);
  Eigen::MatrixXd result(n, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    state << displacement.col(i), velocity.col(i);
    system.detect_contact(time[i], state.data(), workspace);
    system.rhs(time[i], state.data(), rate.data(), workspace);
    result.col(i) = rate.tail(n);
  }
  return result;
}

MotionRange motion_range(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  return {std::sqrt((values.array() - values.mean()).square().mean()), values.maxCoeff() - values.minCoeff()};
}

MotionRange largest_range(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  MotionRange largest;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto [rms, peak_to_peak] = motion_range(rows.row(i));
    largest = {std::max(largest.rms, rms), std::max(largest.peak_to_peak, peak_to_peak)};
  }
  return largest;
}

CycleValues over_cycles(const Eigen::Ref<const Eigen::VectorXd>& values, int cycles) {
  const auto columns = Eigen::Map<const Eigen::MatrixXd>(values.data(), values.size() / cycles, cycles).colwise();
  return {columns.mean(), columns.minCoeff(), columns.maxCoeff()};
}

}  // namespace annulus::dynamics
