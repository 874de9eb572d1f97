#include "dynamics/spatial/elastic_laws.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// The state of a law that depends on the distance alone: force and slope along it.
ElasticLaw::State central_state(const Eigen::VectorXd& deflection, double distance, double energy, double force,
                                double slope) {
  const Eigen::Index n = deflection.size();
  const double across = distance > 0 ? force / distance : slope;
  ElasticLaw::State state{energy, across * deflection, across * Eigen::MatrixXd::Identity(n, n)};
  if (distance > 0) {
    const Eigen::VectorXd along = deflection / distance;
    state.tangent += (slope - across) * along * along.transpose();
  }
  return state;
}

}  // namespace

LinearLaw::LinearLaw(Eigen::MatrixXd stiffness) : stiffness_(std::move(stiffness)) {
  // In units in which the diagonal is 1: rotations and displacements are not comparable.
  Eigen::VectorXd scale = stiffness_.diagonal();
  for (double& s : scale) s = s > 0 ? 1 / std::sqrt(s) : 1.0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * stiffness_ * scale.asDiagonal();
  constexpr double rounding = 1e-9;
  const double asymmetry = (scaled - scaled.transpose()).cwiseAbs().maxCoeff();
  if (!(asymmetry <= rounding))
    throw InputError(
        fmt::format("a stiffness matrix is not symmetric: entries differ by {:.3g} of the diagonal", asymmetry));
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (!(least >= -rounding))
    throw InputError(fmt::format(
        "a stiffness matrix has the negative eigenvalue {:.3g} (in units of its diagonal): it would give energy away",
        least));
  stiffness_ = (stiffness_ + stiffness_.transpose()).eval() / 2;
}

ElasticLaw::State LinearLaw::at(const Eigen::VectorXd& deflection) const {
  State state{0, stiffness_ * deflection, stiffness_};
  state.energy = deflection.dot(state.force) / 2;
  return state;
}

StopLaw::StopLaw(int directions, double stiffness, double play)
    : directions_(directions), stiffness_(stiffness), play_(play) {
  if (!(stiffness > 0) || !std::isfinite(stiffness) || !(play >= 0) || !std::isfinite(play))
    throw InputError(fmt::format(
        "a stop needs a positive stiffness ({:g} N/m) and a play that is not negative ({:g} m)", stiffness, play));
}

ElasticLaw::State StopLaw::at(const Eigen::VectorXd& deflection) const {
  const double d = deflection.norm(), within = play_ > 0 ? stiffness_in_play * stiffness_ : 0.0;
  double energy = within * d * d / 2, force = within * d, slope = within;
  if (d >= play_) {
    energy += stiffness_ * (d - play_) * (d - play_) / 2;
    force += stiffness_ * (d - play_);
    slope += stiffness_;
  }
  return central_state(deflection, d, energy, force, slope);
}

Eigen::MatrixXd StopLaw::in_contact() const { return stiffness_ * Eigen::MatrixXd::Identity(directions_, directions_); }

TableLaw::TableLaw(std::vector<double> distance, std::vector<double> force)
    : distance_(std::move(distance)), force_(std::move(force)) {
  if (distance_.size() != force_.size() || distance_.size() < 2)
    throw InputError(
        fmt::format("a table of a bearing needs as many forces as displacements, two or more, not {} and {}",
                    force_.size(), distance_.size()));
  if (distance_.front() > 0) {
    distance_.insert(distance_.begin(), 0.0);
    force_.insert(force_.begin(), 0.0);
  }
  if (distance_.front() < 0 || force_.front() != 0)
    throw InputError(
        fmt::format("a table of a bearing begins with no force at no displacement, not with {:g} N at {:g} m",
                    force_.front(), distance_.front()));
  for (std::size_t i = 1; i < distance_.size(); ++i) {
    if (!(distance_[i] > distance_[i - 1]) || !(force_[i] >= force_[i - 1]))
      throw InputError(fmt::format("a table of a bearing must rise: {:g} N at {:g} m follow {:g} N at {:g} m",
                                   force_[i], distance_[i], force_[i - 1], distance_[i - 1]));
    steepest_ = std::max(steepest_, (force_[i] - force_[i - 1]) / (distance_[i] - distance_[i - 1]));
  }
  if (!(force_.back() > force_[force_.size() - 2]))
    throw InputError(fmt::format(
        "a table of a bearing must rise up to its end, from where it goes on: {:g} N at {:g} m follow {:g} N at "
        "{:g} m",
        force_.back(), distance_.back(), force_[force_.size() - 2], distance_[distance_.size() - 2]));
}

ElasticLaw::State TableLaw::at(const Eigen::VectorXd& deflection) const {
  const double d = deflection.norm(), within = force_[1] > 0 ? 0.0 : stiffness_in_play * steepest_;
  double energy = within * d * d / 2, force = within * d, slope = within;
  for (std::size_t i = 1; i < distance_.size(); ++i) {
    const bool last = i + 1 == distance_.size(), here = last || d < distance_[i];
    const double piece = (force_[i] - force_[i - 1]) / (distance_[i] - distance_[i - 1]);
    const double way = (here ? d : distance_[i]) - distance_[i - 1];
    energy += (force_[i - 1] + piece * way / 2) * way;
    if (!here) continue;
    force += force_[i - 1] + piece * way;
    slope += piece;
    break;
  }
  return central_state(deflection, d, energy, force, slope);
}

ElasticLaw::State LoadZoneLaw::at(const Eigen::VectorXd& deflection) const {
  const double d = deflection.norm();
  const auto [force, slope] = bearing_(d);
  return central_state(deflection, d, bearing_.energy(d), force, slope);
}

}  // namespace annulus::dynamics
