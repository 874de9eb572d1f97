#include "dynamics/time_integration/pacing.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
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

/// Of the rotation, by which friction acts.
double sense_of(double speed) { return std::clamp(speed / Pacing::slipping, -1.0, 1.0); }

}  // namespace

Pacing::Pacing(const LumpedSystem& system, Course course, const std::string& dof, double turning, AcceleratedBy by)
    : system_(&system), dofs_(system.dofs()), change_(system.dofs()) {
  course.check();
  course_ = course.with_points_at(0);
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
  of_torque_ = mass.solve(torque);
  of_losses_ = mass.solve(system.load(LoadCause::losses));
  of_rotation_ = mass.solve(system.load(LoadCause::rotation));
  const auto& k = system.rotating_stiffness();
  gyroscopic_ = over_mass(mass, system.gyroscopic());
  symmetric_ = over_mass(mass, (k + k.transpose()) / 2);
  skew_ = over_mass(mass, (k - k.transpose()) / 2);
}

std::size_t Pacing::piece_at(double time) const {
  const auto next = std::upper_bound(course_.points.begin() + 1, course_.points.end() - 1, time,
                                     [](double t, const auto& point) { return t < point.time; });
  return static_cast<std::size_t>(next - course_.points.begin()) - 1;
}

Pacing::Now Pacing::at(double time) const {
  const auto &first = course_.points.front(), &last = course_.points.back();
  if (time < 0) return {first.speed * time, first.speed, first.torque, 0};
  if (time >= last.time) return {nominal_.back() + last.speed * (time - last.time), last.speed, last.torque, 0};
  const auto piece = piece_at(time);
  const auto &a = course_.points[piece], &b = course_.points[piece + 1];
  const double since = time - a.time, share = since / (b.time - a.time);
  const double speed = a.speed + share * (b.speed - a.speed);
  return {nominal_[piece] + (a.speed + speed) / 2 * since, speed, a.torque + share * (b.torque - a.torque),
          (b.speed - a.speed) / (b.time - a.time)};
}

double Pacing::least_speed(double from, double to) const {
  double least = std::min(std::abs(at(from).speed), std::abs(at(to).speed));
  for (const auto& point : course_.points)
    if (point.time > from && point.time < to) least = std::min(least, std::abs(point.speed));
  return least;
}

double Pacing::next_stop(double time) const {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto &first = course_.points.front(), &last = course_.points.back();
  const bool before = time < 0, behind = time >= last.time;
  const auto piece = piece_at(time);
  const double end = before ? 0 : behind ? never : course_.points[piece + 1].time;
  const double at_end = before ? first.speed : behind ? last.speed : course_.points[piece + 1].speed;
  const auto now = at(time);
  const double sense = now.speed + at_end;  // neither changes its sign
  if (sense == 0) return end;
  const double ahead = system_->next_jump(now.nominal, sense > 0 ? 1 : -1) - now.nominal;
  const double square = now.speed * now.speed + 2 * now.acceleration * ahead;
  if (!std::isfinite(ahead) || square < 0) return end;  // none, or the course turns before it
  const double jump = time + 2 * ahead / (now.speed + std::copysign(std::sqrt(square), sense));
  constexpr double instant = 1e-13;  // of the time: points and jumps that are as close are one
  return jump < end * (1 - instant) ? jump : end;
}

void Pacing::set_rates(const Now& now, LumpedSystem::Workspace& workspace) {
  workspace.pace = now.speed;
  workspace.sliding = sense_of(now.speed);
}

void Pacing::correct(const Now& now, const double* y, double* dy) const {
  const Eigen::Map<const Eigen::VectorXd> q(y, dofs_), v(y + dofs_, dofs_);
  Eigen::Map<Eigen::VectorXd> rate(dy + dofs_, dofs_);
  const double s = now.speed, square = s * s;
  rate += (now.torque - 1) * of_torque_ + (std::abs(now.torque) * sense_of(s) - 1) * of_losses_ +
          (square - 1) * of_rotation_ + now.acceleration * of_acceleration_;
  if (s == 1) return;
  change_.noalias() = gyroscopic_ * v;
  change_.noalias() += skew_ * q;
  rate += (1 - s) * change_;
  change_.noalias() = symmetric_ * q;
  rate += (1 - square) * change_;
}

void Pacing::correct(const Now& now, Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  const double s = now.speed;
  jacobian.bottomLeftCorner(dofs_, dofs_) += (1 - s) * skew_ + (1 - s * s) * symmetric_;
  jacobian.bottomRightCorner(dofs_, dofs_) += (1 - s) * gyroscopic_;
}

}  // namespace annulus::dynamics
