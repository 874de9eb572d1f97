#include "dynamics/steady_state/frequency_response.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/errors.h"
#include "core/floating_point.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

namespace {

using Complex = std::complex<double>;

}  // namespace

FrequencyResponse::FrequencyResponse(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness)
    : mass_(system.mass()),
      damping_(system.damping_with_meshes() + system.gyroscopic()),
      stiffness_(system.stiffness() + system.rotating_stiffness()),
      b_(system.mesh_vectors()) {
  const Eigen::Index n = system.dofs(), meshes = mesh_stiffness.size();
  require(meshes == static_cast<Eigen::Index>(system.meshes().size()),
          fmt::format("{} stiffnesses for {} meshes", meshes, system.meshes().size()));
  stiffness_ += b_ * mesh_stiffness.asDiagonal() * b_.transpose();
  const Modes found = modes(system, mesh_stiffness);
  const Eigen::Index rigid_motions = neutral_motions(found, stiffness_, mass_);
  const Eigen::MatrixXd shapes = found.shapes();
  Eigen::MatrixXd fixed = stiffness_;
  Eigen::VectorXd squares(n);
  for (Eigen::Index i = 0; i < n; ++i) squares[i] = std::pow(2 * std::numbers::pi * found.modes[i].frequency, 2);
  highest_rate_ = std::sqrt(squares[n - 1]);
  for (Eigen::Index i = 0; i < n && squares[i] == 0; ++i) {
    const Eigen::VectorXd momentum = mass_ * shapes.col(i);
    fixed += mesh_stiffness.maxCoeff() / momentum.cwiseAbs2().maxCoeff() * momentum * momentum.transpose();
  }
  // Scaled to a diagonal of ones: soft supports beside stiff ones are no singularity.
  const Eigen::VectorXd scale = fixed.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(scale.asDiagonal() * fixed * scale.asDiagonal());
  static_inverse_ = scale.asDiagonal() * factor.inverse() * scale.asDiagonal();
  if (!static_inverse_.allFinite() || !(factor.rcond() > 1e-15))
    throw SolverError(
        fmt::format("the system with mean mesh stiffness is singular (reciprocal condition {:.1e}): a degree of "
                    "freedom has no support",
                    factor.rcond()));
  const UntrappedFloatingPoint untrapped;  // the inverse of a defective matrix is infinite, and not used
  find_eigenvalues(shapes, rigid_motions);
  by_eigenvalues_ = eigenvalues_agree();
}

void FrequencyResponse::find_eigenvalues(const Eigen::MatrixXd& shapes, Eigen::Index rigid_motions) {
  const Eigen::Index n = mass_.rows(), elastic = n - rigid_motions;
  // State: elastic displacements and all velocities / w in the undamped modes, in time units of 1/w: entries of order
  // one. Rigid displacements act on nothing; included, they would make the zero eigenvalue defective.
  const double w = highest_rate_;
  const auto bent = shapes.rightCols(elastic);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(elastic + n, elastic + n);
  state.topRightCorner(elastic, elastic).setIdentity();
  state.bottomLeftCorner(n, elastic) = -shapes.transpose() * stiffness_ * bent / (w * w);
  state.bottomRightCorner(n, n) = -shapes.transpose() * damping_ * shapes / w;
  const auto found = eigenpairs(state);
  if (!found) return;
  eigenvalues_ = w * found->values;
  const Eigen::MatrixXcd& vectors = found->vectors;
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(elastic + n, b_.cols());
  force.bottomRows(n) = shapes.transpose() * b_ / w;
  inputs_ = vectors.partialPivLu().solve(force.cast<Complex>());
  outputs_ = bent * vectors.topRows(elastic);
  rigid_rates_ = w * shapes.leftCols(rigid_motions) * vectors.middleRows(elastic, rigid_motions);
}

bool FrequencyResponse::eigenvalues_agree() const {
  if (eigenvalues_.size() == 0 || !inputs_.allFinite()) return false;
  const double highest = eigenvalues_.cwiseAbs().maxCoeff();
  for (const double share : {1e-3, 0.05, 0.3, 1.0}) {
    const double rate = share * highest;
    const Eigen::MatrixXcd expected = b_.transpose() * solve_directly(rate);
    const Eigen::MatrixXd found = transfer_by_eigenvalues(Eigen::VectorXd::Constant(1, rate));
    const auto meshes = b_.cols();
    const double scale = expected.cwiseAbs().maxCoeff();
    if (!((found.leftCols(meshes) - expected.real()).cwiseAbs().maxCoeff() <= 1e-9 * scale)) return false;
    if (!((found.rightCols(meshes) - expected.imag()).cwiseAbs().maxCoeff() <= 1e-9 * scale)) return false;
  }
  return true;
}

Eigen::MatrixXcd FrequencyResponse::dynamic_stiffness(double rate) const {
  return (stiffness_ - rate * rate * mass_).cast<Complex>() + Complex(0, rate) * damping_.cast<Complex>();
}

Eigen::MatrixXcd FrequencyResponse::solve_directly(double rate) const {
  return dynamic_stiffness(rate).partialPivLu().solve(b_.cast<Complex>());
}

Eigen::VectorXcd FrequencyResponse::displacement(double rate, const Eigen::VectorXcd& force) const {
  return dynamic_stiffness(rate).partialPivLu().solve(force);
}

Eigen::MatrixXd FrequencyResponse::mesh_transfer(const Eigen::VectorXd& rates) const {
  if (by_eigenvalues_) return transfer_by_eigenvalues(rates);
  const Eigen::Index meshes = b_.cols(), lines = rates.size();
  Eigen::MatrixXd result(meshes, 2 * meshes * lines);
  for (Eigen::Index j = 0; j < lines; ++j) {
    const Eigen::MatrixXcd transfer = b_.transpose() * solve_directly(rates[j]);
    result.middleCols(2 * meshes * j, meshes) = transfer.real();
    result.middleCols(2 * meshes * j + meshes, meshes) = transfer.imag();
  }
  return result;
}

Eigen::MatrixXd FrequencyResponse::transfer_by_eigenvalues(const Eigen::VectorXd& rates) const {
  const Eigen::Index meshes = b_.cols(), size = meshes * meshes, lines = rates.size();
  Eigen::MatrixXd result(meshes, 2 * meshes * lines);
  // Conjugate pairs p together: (P s + Q) / (s^2 - 2 Re(p) s + |p|^2) with real P and Q, so that all lines are one real
  // matrix product.
  const Eigen::MatrixXcd out = b_.transpose() * outputs_;
  const Eigen::Index count = eigenvalues_.size();
  Eigen::MatrixXd terms(size, count);
  Eigen::MatrixXd lines_of_terms(count, 2 * lines);  // real and imaginary part of a line side by side
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Complex p = eigenvalues_[i];
    if (p.imag() < 0) continue;
    const Eigen::MatrixXcd residue = out.col(i) * inputs_.row(i);
    const bool pair = p.imag() > 0;
    if (pair) {
      terms.col(column) = 2 * residue.real().reshaped();
      terms.col(column + 1) = -2 * (residue * std::conj(p)).real().reshaped();
    } else {
      terms.col(column) = residue.real().reshaped();
    }
    for (Eigen::Index j = 0; j < lines; ++j) {
      const Complex s(0, rates[j]);
      const Complex g = pair ? 1.0 / (s * s - 2 * p.real() * s + std::norm(p)) : 1.0 / (s - p.real());
      const Complex first = pair ? s * g : g;
      lines_of_terms(column, 2 * j) = first.real();
      lines_of_terms(column, 2 * j + 1) = first.imag();
      if (!pair) continue;
      lines_of_terms(column + 1, 2 * j) = g.real();
      lines_of_terms(column + 1, 2 * j + 1) = g.imag();
    }
    column += pair ? 2 : 1;
  }
  require(column == count, fmt::format("{} of {} eigenvalues are conjugate pairs or real", column, count));
  Eigen::Map<Eigen::MatrixXd>(result.data(), size, 2 * lines).noalias() = terms * lines_of_terms;
  return result;
}

Eigen::MatrixXcd FrequencyResponse::displacements(const Eigen::VectorXd& rates, const Eigen::MatrixXcd& forces) const {
  const Eigen::Index lines = forces.cols();
  if (!by_eigenvalues_) {
    Eigen::MatrixXcd result(b_.rows(), lines);
    for (Eigen::Index j = 0; j < lines; ++j) result.col(j) = solve_directly(rates[j]) * forces.col(j);
    return result;
  }
  Eigen::MatrixXcd amplitudes = inputs_ * forces;
  for (Eigen::Index j = 0; j < lines; ++j) amplitudes.col(j).array() /= Complex(0, rates[j]) - eigenvalues_.array();
  Eigen::MatrixXcd result = outputs_ * amplitudes;
  if (rigid_rates_.size() != 0) {
    const Eigen::MatrixXcd velocities = rigid_rates_ * amplitudes;
    for (Eigen::Index j = 0; j < lines; ++j) result.col(j) += velocities.col(j) / Complex(0, rates[j]);
  }
  return result;
}

Eigen::VectorXd FrequencyResponse::static_displacement(const Eigen::VectorXd& force) const {
  return static_inverse_ * force;
}

}  // namespace annulus::dynamics
