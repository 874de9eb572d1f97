#include "dynamics/statics/meshed_stiffness.h"

#include <utility>

namespace annulus::dynamics {

MeshedStiffness::MeshedStiffness(Eigen::MatrixXd stiffness, Eigen::MatrixXd vectors, const Eigen::VectorXd& mean)
    : stiffness_(std::move(stiffness)), vectors_(std::move(vectors)), mean_(mean) {
  if (vectors_.cols() == 0 || vectors_.cols() >= vectors_.rows()) return;
  whole_.compute(stiffness_ + vectors_ * mean_.asDiagonal() * vectors_.transpose());
  reducible_ = whole_.info() == Eigen::Success;
  if (!reducible_) return;
  inverse_ = whole_.solve(Eigen::MatrixXd::Identity(vectors_.rows(), vectors_.rows()));
  of_meshes_ = inverse_ * vectors_;
  across_ = vectors_.transpose() * of_meshes_;
}

void MeshedStiffness::set_vectors(Eigen::MatrixXd vectors) {
  vectors_ = std::move(vectors);
  reducible_ = false;  // each is used a few times only
}

bool MeshedStiffness::suits_formula(const Eigen::MatrixXd& tangent) {
  constexpr double softest = 0.05;
  if ((tangent.diagonal().array() < softest * mean_.array()).any()) return false;
  tangent_.compute(tangent);
  return tangent_.info() == Eigen::Success;
}

bool MeshedStiffness::factorise(const Eigen::MatrixXd& tangent) {
  reduced_ = reducible_ && suits_formula(tangent);
  if (!reduced_) {
    whole_.compute(stiffness_ + vectors_ * tangent * vectors_.transpose());
    return whole_.info() == Eigen::Success;
  }
  change_ = tangent;
  change_.diagonal() -= mean_;
  small_.compute(Eigen::MatrixXd::Identity(change_.rows(), change_.cols()) + change_ * across_);
  return true;
}

Eigen::MatrixXd MeshedStiffness::solve(const Eigen::MatrixXd& force) const {
  if (!reduced_) return whole_.solve(force);
  const Eigen::MatrixXd q = inverse_ * force;
  return q - of_meshes_ * small_.solve(change_ * (vectors_.transpose() * q));
}

}  // namespace annulus::dynamics
