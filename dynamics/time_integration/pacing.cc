#include "dynamics/time_integration/pacing.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/errors.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

namespace {

/// m/s at all DOFs while the system turns as a whole.
Eigen::VectorXd rotation_of(const LumpedSystem& system, const std::string& dof, double turning) {
  const Modes found = modes(system);
  const auto free =
      std::count_if(found.modes.begin(), found.modes.end(), [](const auto& m) { return m.frequency == 0; });
  if (free != 1)
    throw InputError(
        fmt::format("the speed can change in one free rotation alone, and there are {}: a torsional support "
                    "holds the bodies, or nothing connects some of them. Leave speed_factor out, or let "
                    "them turn",
                    free));
  const int reference = system.find(dof);
  require(reference >= 0 && turning != 0, fmt::format("degree of freedom '{}' turns with {} m/s", dof, turning));
  const auto& shape = found.modes.front().shape;
  if (!(std::abs(shape[reference]) > 1e-6 * shape.cwiseAbs().maxCoeff()))
    throw InputError(fmt::format("the free rotation leaves '{}' at rest", dof));
  return turning / shape[reference] * shape;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> over_mass(const Eigen::LLT<Eigen::MatrixXd>& mass,
                                                       const Eigen::MatrixXd& matrix) {
  constexpr double rounding = 1e-14;
  const Eigen::MatrixXd solved = mass.solve(matrix);
  return solved.sparseView(solved.cwiseAbs().maxCoeff(), rounding);
}

}  // namespace

Pacing::Pacing(const LumpedSystem& system, Course course, const std::string& dof, double turning, AcceleratedBy by)
    : dofs_(system.dofs()), course_(std::move(course)), change_(system.dofs()) {
  course_.check();
  nominal_ = course_.nominal_times();
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  const auto& torque = system.load(LoadCause::torque);
  rotation_ = of_acceleration_ = Eigen::VectorXd::Zero(dofs_);
  const bool changes = std::any_of(course_.points.begin(), course_.points.end(),
                                   [&](const auto& p) { return p.speed != course_.points.front().speed; });
  if (changes) rotation_ = rotation_of(system, dof, turning);
  Eigen::VectorXd bearing = torque;  // those that bear the torque of the inertias
  for (Eigen::Index i = 0; i < bearing.size(); ++i)
    if ((torque[i] * rotation_[i] > 0) != (by == AcceleratedBy::drive)) bearing[i] = 0;
  const double power = bearing.dot(rotation_);
  if (changes && power == 0)
    throw InputError(
        fmt::format("no torque {} the system, which could turn its inertias faster; give a torque, or let "
                    "the other side turn them (inertia_turned_by)",
                    by == AcceleratedBy::drive ? "drives" : "loads"));
  if (changes) of_acceleration_ = mass.solve(rotation_.dot(system.mass() * rotation_) / power * bearing) - rotation_;
  of_torque_ = mass.solve(torque + system.load(LoadCause::losses));
  of_rotation_ = mass.solve(system.load(LoadCause::rotation));
  const auto& k = system.rotating_stiffness();
  damping_ = over_mass(mass, system.damping());
  gyroscopic_ = over_mass(mass, system.gyroscopic());
  symmetric_ = over_mass(mass, (k + k.transpose()) / 2);
  skew_ = over_mass(mass, (k - k.transpose()) / 2);
}

Pacing::Now Pacing::at(double nominal) const {
  if (const auto& first = course_.points.front(); nominal < 0)
    return {nominal / first.speed, first.speed, first.torque, 0};
  const auto next = std::upper_bound(nominal_.begin() + 1, nominal_.end() - 1, nominal) - nominal_.begin();
  const auto &a = course_.points[static_cast<std::size_t>(next) - 1],
             &b = course_.points[static_cast<std::size_t>(next)];
  const double since = nominal - nominal_[static_cast<std::size_t>(next) - 1];
  if (nominal >= nominal_.back()) return {b.time + (nominal - nominal_.back()) / b.speed, b.speed, b.torque, 0};
  const double acceleration = (b.speed - a.speed) / (b.time - a.time);
  // The nominal time grows with the square of the time.
  const double speed = std::sqrt(a.speed * a.speed + 2 * acceleration * since);
  const double time = 2 * since / (a.speed + speed);
  return {a.time + time, speed, a.torque + (b.torque - a.torque) * time / (b.time - a.time), acceleration};
}

void Pacing::correct(double nominal, const double* y, double* dy) const {
  const auto now = at(nominal);
  const Eigen::Map<const Eigen::VectorXd> q(y, dofs_), u(y + dofs_, dofs_);
  Eigen::Map<Eigen::VectorXd> rate(dy + dofs_, dofs_);
  const double s = now.speed, square = s * s;
  rate += (now.torque - 1) * of_torque_ + (square - 1) * of_rotation_ + now.acceleration * (of_acceleration_ - u);
  if (s != 1) {
    change_.noalias() = damping_ * u;
    change_.noalias() += skew_ * q;
    rate += (1 - s) * change_;
    change_.noalias() = gyroscopic_ * u;
    change_.noalias() += symmetric_ * q;
    rate += (1 - square) * change_;
  }
  rate /= square;
}

}  // namespace annulus::dynamics
