#include "dynamics/steady_state/piecewise_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

PiecewiseSystem::PiecewiseSystem(const LumpedSystem& system)
    : system_(system),
      workspace_(system.workspace()),
      dofs_(system.dofs()),
      b_(system.mesh_vectors()),
      stiffness_(system.stiffness() + system.rotating_stiffness()),
      damping_(system.damping_with_meshes() + system.gyroscopic()) {
  set_modes();
  set_static();
  set_errors();
  const Eigen::Index last = size() - 1 - errors_.cols();
  penetration_.setZero(b_.cols(), size());
  penetration_.leftCols(elastic_) = b_.transpose() * shapes_.leftCols(elastic_);
  penetration_.col(last) = preload_;
  penetration_.rightCols(errors_.cols()) = -errors_;
  penetration_rate_.setZero(b_.cols(), size());
  // Meshes do not see rigid motions; what rounding leaves is dropped.
  penetration_rate_.middleCols(elastic_, elastic_) = w_ * penetration_.leftCols(elastic_);
  penetration_rate_.rightCols(errors_.cols()) = -error_rates_;
  if (rigid() > 0) {
    const Eigen::MatrixXd back = shapes_.rightCols(rigid()).transpose() * damping_ * shapes_ / w_;
    // Rounding of the projected dampers against their size.
    if (back.rightCols(rigid()).cwiseAbs().maxCoeff() <=
        1e-12 * (shapes_.transpose() * damping_ * shapes_).cwiseAbs().maxCoeff() / w_) {
      conserved_.setZero(rigid(), inner());
      conserved_.leftCols(elastic_) = back.leftCols(elastic_);
      conserved_.rightCols(rigid()).setIdentity();
    }
  }
}

void PiecewiseSystem::set_modes() {
  const Modes found = modes(system_, mean_stiffnesses(system_));
  const Eigen::Index n = dofs_;
  require(n > 0 && found.modes.back().frequency > 0,
          fmt::format("a piecewise linear system needs an elastic mode; {} degrees of freedom have none", n));
  const auto first =
      std::find_if(found.modes.begin(), found.modes.end(), [](const Mode& m) { return m.frequency > 0; });
  const Eigen::Index rigid_motions = first - found.modes.begin();
  elastic_ = n - rigid_motions;
  shapes_.resize(n, n);
  squares_.resize(elastic_);
  for (Eigen::Index i = 0; i < n; ++i) {
    shapes_.col((i + elastic_) % n) = found.modes[i].shape;
    if (i >= rigid_motions) squares_[i - rigid_motions] = std::pow(2 * std::numbers::pi * found.modes[i].frequency, 2);
  }
  w_ = std::sqrt(squares_[elastic_ - 1]);
  for (Eigen::Index i = elastic_; i < n; ++i) {
    const Eigen::VectorXd nu = shapes_.col(i);
    neutral_ = neutral_ && costs_no_force(nu, stiffness_, system_.mass());
    const double work = std::abs(nu.dot(system_.load()));
    if (work > 1e-9 * nu.cwiseAbs().dot(system_.load().cwiseAbs()))  // a balanced load cancels to rounding
      refuse_unbalanced(system_, nu);
  }
}

void PiecewiseSystem::set_static() {
  preload_.resize(b_.cols());
  Eigen::VectorXd force = system_.load();
  for (Eigen::Index m = 0; m < b_.cols(); ++m) {
    const auto& mesh = system_.meshes()[m];
    preload_[m] = -mesh.half_backlash.value_or(0.0);
    for (const auto& e : mesh.errors)
      if (e.rate == 0) preload_[m] -= e.amount * std::sin(e.phase);
    force -= mean_stiffness(mesh.excitation) * preload_[m] * b_.col(m);
  }
  const auto bent = shapes_.leftCols(elastic_);
  static_ = bent * (bent.transpose() * force).cwiseQuotient(squares_);
  preload_ += b_.transpose() * static_;
}

void PiecewiseSystem::set_errors() {
  for (const auto& mesh : system_.meshes())
    for (const auto& e : mesh.errors)
      if (e.rate != 0 && e.amount != 0 && std::find(rates_.begin(), rates_.end(), std::abs(e.rate)) == rates_.end())
        rates_.push_back(std::abs(e.rate));
  errors_.setZero(b_.cols(), 2 * static_cast<Eigen::Index>(rates_.size()));
  for (Eigen::Index m = 0; m < b_.cols(); ++m)
    for (const auto& e : system_.meshes()[m].errors) {
      if (e.rate == 0 || e.amount == 0) continue;
      const auto slot = 2 * (std::find(rates_.begin(), rates_.end(), std::abs(e.rate)) - rates_.begin());
      errors_(m, slot) += (e.rate > 0 ? e.amount : -e.amount) * std::cos(e.phase);
      errors_(m, slot + 1) += e.amount * std::sin(e.phase);
    }
  error_rates_.setZero(errors_.rows(), errors_.cols());
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const auto s = 2 * static_cast<Eigen::Index>(i);
    error_rates_.col(s) = -rates_[i] * errors_.col(s + 1);
    error_rates_.col(s + 1) = rates_[i] * errors_.col(s);
  }
}

PiecewiseSystem::Combination PiecewiseSystem::make(const LumpedSystem::Workspace& workspace) const {
  const Eigen::Index n = dofs_, e = elastic_, known = inner() + rigid(), harmonics = errors_.cols();
  const Eigen::Map<const Eigen::VectorXd> k(workspace.stiffness.data(), b_.cols());
  Combination c;
  c.waves = workspace.wave;
  c.force = k.asDiagonal() * penetration_;
  Eigen::VectorXd damping(b_.cols());
  for (Eigen::Index m = 0; m < b_.cols(); ++m) damping[m] = system_.meshes()[m].damping;
  c.force += damping.asDiagonal() * penetration_rate_;
  // In units of 1/w; rows of the velocities: shapes^T (f - K q - C q' - B F).
  Eigen::MatrixXd& a = c.matrix;
  a.setZero(size(), size());
  a.block(0, e, e, e).setIdentity();
  a.block(inner(), 2 * e, rigid(), rigid()).setIdentity();
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(n, size());
  force.leftCols(e) = -stiffness_ * shapes_.leftCols(e);
  force.middleCols(e, n) = -w_ * (system_.damping() + system_.gyroscopic()) * shapes_;
  force.col(known) = system_.load() - stiffness_ * static_;
  force -= b_ * c.force;
  a.middleRows(e, n) = shapes_.transpose() * force / (w_ * w_);
  if (rigid() > 0) {
    // Nothing elastic acts on rigid motions: what rounding leaves would make them creep.
    a.block(2 * e, 0, rigid(), e).setZero();
    a.block(2 * e, known, rigid(), 1 + harmonics).setZero();
    a.block(2 * e, e, rigid(), n) =
        -shapes_.rightCols(rigid()).transpose() * (system_.damping() + system_.gyroscopic()) * shapes_ / w_;
  }
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const Eigen::Index s = known + 1 + 2 * static_cast<Eigen::Index>(i);
    a(s, s + 1) = rates_[i] / w_;
    a(s + 1, s) = -rates_[i] / w_;
  }
  return c;
}

int PiecewiseSystem::combination(double t) {
  system_.hold_waves(t, workspace_);
  const auto known = std::find_if(combinations_.begin(), combinations_.end(),
                                  [&](const Combination& c) { return c.waves == workspace_.wave; });
  if (known != combinations_.end()) return static_cast<int>(known - combinations_.begin());
  system_.evaluate_excitation(t, workspace_);
  combinations_.push_back(make(workspace_));
  return static_cast<int>(combinations_.size()) - 1;
}

const Eigen::MatrixXd& PiecewiseSystem::propagator(int combination, double duration) {
  auto& c = combinations_[combination];
  // Durations that differ by rounding are one: 1e-11 of 1/w changes the state by as much. Of long ones rounding is a
  // share of the duration.
  constexpr double same = 1e-11, long_duration = 1e4;
  const double x = w_ * duration;
  const auto [entry, made] =
      c.propagators.try_emplace(x < long_duration ? std::llround(x / same) : -std::llround(std::log(x) / same));
  if (made) entry->second = exponential(c.matrix * (w_ * duration));
  return entry->second;
}

Eigen::VectorXd PiecewiseSystem::displacement(const Eigen::VectorXd& z) const {
  return static_ + shapes_.leftCols(elastic_) * z.head(elastic_) +
         shapes_.rightCols(rigid()) * z.segment(inner(), rigid());
}

Eigen::VectorXd PiecewiseSystem::velocity(const Eigen::VectorXd& z) const {
  return w_ * (shapes_ * z.segment(elastic_, dofs_));
}

void PiecewiseSystem::set_excitation(double t, Eigen::Ref<Eigen::VectorXd> z) const {
  Eigen::Index i = inner() + rigid();
  z[i++] = 1;
  for (const double rate : rates_) {
    z[i++] = std::sin(rate * t);
    z[i++] = std::cos(rate * t);
  }
}

}  // namespace annulus::dynamics
