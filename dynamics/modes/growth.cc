#include "dynamics/modes/growth.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/log.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/linear_system.h"

namespace annulus::dynamics {

Growth fastest_growth(const LumpedSystem& system) {
  const auto linear = linear_system(system);
  const Eigen::Index n = linear.mass.rows();
  if (n == 0) return {};
  const Eigen::LLT<Eigen::MatrixXd> mass(linear.mass);
  const Eigen::MatrixXd stiffness = mass.solve(linear.stiffness + linear.rotating_stiffness);
  // Displacements and velocities in units of one size, of which rounding is a part.
  const double scale = std::sqrt(stiffness.diagonal().cwiseAbs().maxCoeff());
  if (!(scale > 0)) return {};
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n).diagonal().setConstant(scale);
  state.bottomLeftCorner(n, n) = -stiffness / scale;
  state.bottomRightCorner(n, n) = -mass.solve(linear.damping + linear.gyroscopic);
  const auto pairs = eigenpairs(state);
  if (!pairs) {
    log::warn(fmt::format("whether small motions grow is not known: the eigenvalues of {} DOF were not found", n));
    return {};
  }
  Eigen::Index fastest = 0, largest = 0;
  const double found = pairs->values.real().maxCoeff(&fastest);
  pairs->vectors.col(fastest).head(n).cwiseAbs().maxCoeff(&largest);
  // Double eigenvalues of rigid motions are separated by the square root of rounding.
  const double seen = 1e-7 * pairs->values.cwiseAbs().maxCoeff();
  return {found > seen ? found : std::min(found, 0.0), std::abs(pairs->values[fastest].imag()) / (2 * std::numbers::pi),
          linear.dofs.at(static_cast<std::size_t>(largest))};
}

void refuse_growth(const LumpedSystem& system, double mesh_frequency) {
  const auto growth = fastest_growth(system);
  if (growth.rate <= unseen_growth * mesh_frequency) return;
  throw InputError(fmt::format(
      "unstable at this speed: small motions grow e-fold within {:.3g} s{}, most of all {}. A body is held more softly "
      "than its centrifugal or gyroscopic forces or damping that turns require. Use stiffer bearings or supports, "
      "fewer floating bodies, or a lower speed",
      1 / growth.rate, growth.frequency > 0 ? fmt::format(", at {:.4g} Hz", growth.frequency) : " without oscillation",
      growth.dof));
}

}  // namespace annulus::dynamics
