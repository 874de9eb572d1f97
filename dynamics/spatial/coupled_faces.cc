#include "dynamics/spatial/coupled_faces.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

CoupledFaces::CoupledFaces(std::vector<std::shared_ptr<const FaceLaw>> meshes, Eigen::MatrixXd compliance)
    : meshes_(std::move(meshes)), compliance_(std::move(compliance)), first_{0} {
  if (compliance_.rows() != this->meshes() || compliance_.cols() != this->meshes())
    throw InputError(fmt::format("{} meshes are coupled by a compliance of {} x {}", this->meshes(), compliance_.rows(),
                                 compliance_.cols()));
  for (const auto& mesh : meshes_) first_.push_back(first_.back() + mesh->size());
}

/// Meshes x coordinates: total forces from those at the stations.
Eigen::MatrixXd CoupledFaces::sums() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(meshes(), size());
  for (Eigen::Index n = 0; n < meshes(); ++n) {
    const auto mesh = static_cast<std::size_t>(n);
    result.row(n).segment(first_[mesh], std::ssize(meshes_[mesh]->stations())).setOnes();
  }
  return result;
}

void CoupledFaces::soften(Eigen::MatrixXd& tangent) const {
  const Eigen::MatrixXd sum = sums(), moved = tangent * sum.transpose();
  const Eigen::MatrixXd alone = sum * moved;
  const Eigen::MatrixXd share =
      compliance_ * (Eigen::MatrixXd::Identity(meshes(), meshes()) + alone * compliance_).partialPivLu().inverse();
  tangent -= moved * ((share + share.transpose()) / 2) * moved.transpose();
}

Eigen::VectorXd CoupledFaces::expected(const Eigen::VectorXd& approach) const {
  if (last_force_.size() == 0) return Eigen::VectorXd::Zero(meshes());
  return (last_force_ + last_slope_ * (approach - last_approach_)).cwiseMax(0);
}

void CoupledFaces::remember(const Eigen::VectorXd& approach, const State& state) const {
  last_approach_ = approach;
  last_force_ = sums() * state.force;
  last_slope_ = sums() * state.tangent;
}

ElasticLaw::State CoupledFaces::at(const Eigen::VectorXd& approach) const {
  constexpr int most = 100;
  constexpr double wanted = 1e-13;
  State state;
  Eigen::VectorXd force = expected(approach);
  // The meshes at forces that they may not have, and what these differ by from their own.
  const auto evaluate = [&](const Eigen::VectorXd& assumed) {
    const Eigen::VectorXd loss = compliance_ * assumed;
    state = {assumed.dot(loss) / 2, Eigen::VectorXd::Zero(size()), Eigen::MatrixXd::Zero(size(), size())};
    Eigen::VectorXd rest = assumed;
    for (Eigen::Index n = 0; n < meshes(); ++n) {
      const auto mesh = static_cast<std::size_t>(n);
      const Eigen::Index first = first_[mesh], count = meshes_[mesh]->size();
      Eigen::VectorXd own = approach.segment(first, count);
      own.head(std::ssize(meshes_[mesh]->stations())).array() -= loss[n];
      const State alone = meshes_[mesh]->at(own);
      state.energy += alone.energy;
      state.force.segment(first, count) = alone.force;
      state.tangent.block(first, first, count, count) = alone.tangent;
      rest[n] -= meshes_[mesh]->force(alone);
    }
    return rest;
  };
  Eigen::VectorXd rest = evaluate(force);
  const Eigen::MatrixXd sum = sums();
  for (int i = 0; i < most; ++i) {
    const double size = std::max(force.cwiseAbs().maxCoeff(), state.force.cwiseAbs().maxCoeff());
    if (rest.cwiseAbs().maxCoeff() <= wanted * size) {
      soften(state.tangent);
      remember(approach, state);
      return state;
    }
    const Eigen::MatrixXd slope =
        Eigen::MatrixXd::Identity(meshes(), meshes()) + sum * state.tangent * sum.transpose() * compliance_;
    const Eigen::VectorXd step = slope.partialPivLu().solve(-rest), from = force;
    const double before = rest.norm();
    // Contacts that open or close on the way may make the whole step too long.
    for (double length = 1; length > 1e-6; length /= 2) {
      force = from + length * step;
      rest = evaluate(force);
      if (rest.norm() < before * (1 - length / 4)) break;
    }
    if (!(rest.norm() < before) && rest.cwiseAbs().maxCoeff() <= 1e-10 * size) {
      soften(state.tangent);
      remember(approach, state);
      return state;
    }
  }
  throw SolverError(fmt::format("the forces of {} coupled meshes are not found: {:.3g} N are left over", meshes(),
                                rest.cwiseAbs().maxCoeff()));
}

Eigen::MatrixXd CoupledFaces::in_contact() const {
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh)
    tangent.block(first_[mesh], first_[mesh], meshes_[mesh]->size(), meshes_[mesh]->size()) =
        meshes_[mesh]->in_contact();
  soften(tangent);
  return tangent;
}

Eigen::VectorXd CoupledFaces::losses(const State& state) const { return compliance_ * (sums() * state.force); }

}  // namespace annulus::dynamics
