#include "dynamics/spatial/mechanism.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

Mechanism::Mechanism(double length) : length_(length) {
  if (!(length > 0)) throw InternalError(fmt::format("internal error: a mechanism of the length {:g} m", length));
}

int Mechanism::add_body(RigidBody body) {
  if (!elements_.empty() || !holds_.empty() || load_.size() > 0)
    throw InternalError("internal error: body '" + body.name + "' is added after elements, holds or loads");
  bodies_.push_back(std::move(body));
  return bodies() - 1;
}

Mechanism::Measure Mechanism::displacement(int body, int from, const Eigen::Vector3d& point,
                                           const Eigen::Vector3d& direction) const {
  Measure row = Measure::Zero(size());
  const auto add = [&](int number, double sign) {
    if (number == ground) return;
    row.segment<3>(6 * number) += sign * direction.transpose();
    row.segment<3>(6 * number + 3) += sign * (point - this->body(number).reference).cross(direction).transpose();
  };
  add(body, 1);
  add(from, -1);
  return row;
}

Mechanism::Measure Mechanism::rotation(int body, int from, const Eigen::Vector3d& direction) const {
  Measure row = Measure::Zero(size());
  if (body != ground) row.segment<3>(6 * body + 3) += direction.transpose();
  if (from != ground) row.segment<3>(6 * from + 3) -= direction.transpose();
  return row;
}

int Mechanism::add_element(std::string name, Eigen::MatrixXd measures, std::shared_ptr<const ElasticLaw> law,
                           Eigen::VectorXd offset) {
  if (measures.rows() != law->size() || measures.cols() != size() || offset.size() != law->size())
    throw InternalError(
        fmt::format("internal error: element '{}' has a law of {} coordinates, {} x {} measures and {} "
                    "offsets",
                    name, law->size(), measures.rows(), measures.cols(), offset.size()));
  elements_.push_back({std::move(name), std::move(measures), std::move(law), std::move(offset)});
  return static_cast<int>(elements_.size()) - 1;
}

int Mechanism::hold(std::string name, const Measure& measure) {
  hold_names_.push_back(std::move(name));
  holds_.push_back(measure);
  return static_cast<int>(holds_.size()) - 1;
}

void Mechanism::add_load(int body, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                         const Eigen::Vector3d& moment) {
  if (load_.size() == 0) load_ = Eigen::VectorXd::Zero(size());
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    load_ += force[i] * displacement(body, ground, point, unit).transpose();
    load_ += moment[i] * rotation(body, ground, unit).transpose();
  }
}

Eigen::VectorXd Mechanism::deflection(int element, const Eigen::VectorXd& motion) const {
  const auto& e = elements_.at(static_cast<std::size_t>(element));
  return e.measures * motion - e.offset;
}

/// In coordinates y of the motions that are free: motion = basis y. Rotations are lengths in it.
class Mechanism::Solver {
 public:
  explicit Solver(const Mechanism& mechanism) : mechanism_(mechanism) {
    scale_ = Eigen::VectorXd::Ones(mechanism.size());
    std::vector<Eigen::Index> kept;
    for (int b = 0; b < mechanism.bodies(); ++b)
      for (Eigen::Index i = 0; i < 6; ++i) {
        const Eigen::Index dof = 6 * static_cast<Eigen::Index>(b) + i;
        if (i >= 3) scale_[dof] = 1 / mechanism.length_;
        const bool in_plane = i < 2 || i == 5;
        if (in_plane || mechanism.body(b).moves_in_space) kept.push_back(dof);
      }
    basis_ = Eigen::MatrixXd::Zero(mechanism.size(), std::ssize(kept));
    for (Eigen::Index k = 0; k < std::ssize(kept); ++k)
      basis_(kept[static_cast<std::size_t>(k)], k) = scale_[kept[static_cast<std::size_t>(k)]];
    free_ = basis_;
    if (!mechanism.holds_.empty()) hold();
    load_ = mechanism.load_.size() > 0 ? mechanism.load_ : Eigen::VectorXd::Zero(mechanism.size());
    for (const auto& e : mechanism.elements_) reduced_.push_back(e.measures * basis_);
    in_contact_ = Eigen::MatrixXd::Zero(basis_.cols(), basis_.cols());
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      in_contact_ += reduced_[e].transpose() * mechanism.elements_[e].law->in_contact() * reduced_[e];
    check_stable();
  }

  Equilibrium solve(const Eigen::VectorXd& start) {
    constexpr int most = 200;
    constexpr double wanted = 1e-12, rounding = 1e-9;
    Eigen::VectorXd y = start.size() > 0 ? Eigen::VectorXd(basis_.colPivHouseholderQr().solve(start)) : first_guess();
    Equilibrium result;
    evaluate(y, result);
    double best = residual(result);
    for (int i = 1;; ++i) {
      if (result.residual_relative <= wanted) break;
      if (i > most)
        throw SolverError(fmt::format("no equilibrium found: after {} iterations {:.2g} of the forces are left over",
                                      most, result.residual_relative));
      step(y, result);
      result.iterations = i;
      const double now = residual(result);
      // Where rounding is larger than what is wanted, it no longer falls.
      if (!(now < best / 2) && now <= rounding) break;
      best = std::min(best, now);
    }
    result.motion = basis_ * y;
    check_small(result.motion);
    find_holding(result);
    return result;
  }

 private:
  void hold() {
    const auto& names = mechanism_.hold_names_;
    Eigen::MatrixXd rows(std::ssize(names), basis_.cols());
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
      rows.row(r) = mechanism_.holds_[static_cast<std::size_t>(r)] * basis_;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rows.transpose());
    factors.setThreshold(1e-10);
    if (factors.rank() < rows.rows()) {
      const auto surplus = static_cast<std::size_t>(factors.colsPermutation().indices()[factors.rank()]);
      throw InputError(fmt::format(
          "{} is already held rigidly by other supports; how they share the load depends on their stiffness: give them "
          "one",
          names[surplus]));
    }
    const Eigen::MatrixXd orthogonal = factors.householderQ();
    basis_ = (basis_ * orthogonal.rightCols(basis_.cols() - rows.rows())).eval();
  }

  /// Does anything resist every motion, when all that can touch does?
  void check_stable() const {
    if (basis_.cols() == 0) return;
    // In units of the stiffness of each coordinate: soft bearings stand beside stiff ones.
    Eigen::VectorXd unit = in_contact_.diagonal();
    for (double& u : unit) u = u > 0 ? 1 / std::sqrt(u) : 1.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(unit.asDiagonal() * in_contact_ * unit.asDiagonal());
    constexpr double rounding = 1e-12;
    if (modes.eigenvalues()[0] > rounding) return;
    // In lengths.
    const Eigen::VectorXd motion = (basis_ * (unit.asDiagonal() * modes.eigenvectors().col(0))).cwiseQuotient(scale_);
    Eigen::Index largest = 0;
    double most = motion.cwiseAbs().maxCoeff(&largest);
    // Where a body tilts, those that ride on it move along the axis by as much.
    Eigen::VectorXd tilts = motion.cwiseAbs();
    for (Eigen::Index i = 0; i < tilts.size(); ++i)
      if (i % 6 != 3 && i % 6 != 4) tilts[i] = 0;
    Eigen::Index tilted = 0;
    constexpr double beside = 0.3;  // of the largest displacement
    if (const double tilt = tilts.maxCoeff(&tilted); tilt > beside * most) {
      most = tilt;
      largest = tilted;
    }
    constexpr const char* words[] = {"along x", "along y", "along the axis", "about x", "about y", "about the axis"};
    std::vector<std::string> names;
    for (int b = 0; b < mechanism_.bodies(); ++b)
      if (std::abs(motion[6 * b + largest % 6]) >= 0.1 * most) names.push_back(mechanism_.body(b).name);
    throw InputError(fmt::format("nothing resists a motion of {} {}{}: give {} a bearing or support that does",
                                 fmt::join(names, ", "), words[largest % 6], names.size() > 1 ? " together" : "",
                                 names.size() > 1 ? "one of them" : "it"));
  }

  /// What is left of a bearing in its play lets a body go whose load nothing bears.
  void check_small(const Eigen::VectorXd& motion) const {
    constexpr double large = 0.1;  // of the bodies: displacements are small beside these
    for (int b = 0; b < mechanism_.bodies(); ++b) {
      const Eigen::Vector3d moved = motion.segment<3>(6 * static_cast<Eigen::Index>(b));
      Eigen::Index along = 0;
      const double most = moved.cwiseAbs().maxCoeff(&along);
      if (most <= large * mechanism_.length_) continue;
      constexpr const char* words[] = {"x", "y", "z"};
      const char* rows = along < 2 ? ""
                                   : ". Rows of rolling elements hold in one direction along the axis, against a "
                                     "displacement along +z with a positive contact angle";
      throw InputError(
          fmt::format("the {} would move by {:.3g} m along {}{}: what holds it there is too soft for the "
                      "loads of the stage, or lets it go{}",
                      mechanism_.body(b).name, most, moved[along] < 0 ? "-" : "+", words[along], rows));
    }
  }

  /// Where everything is in contact and pulls as well.
  [[nodiscard]] Eigen::VectorXd first_guess() const {
    Eigen::VectorXd right = basis_.transpose() * load_;
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      right += reduced_[e].transpose() * (mechanism_.elements_[e].law->in_contact() * mechanism_.elements_[e].offset);
    return in_contact_.ldlt().solve(right);
  }

  void evaluate(const Eigen::VectorXd& y, Equilibrium& result) const {
    result.deflection.resize(reduced_.size());
    result.state.resize(reduced_.size());
    for (std::size_t e = 0; e < reduced_.size(); ++e) {
      const auto& element = mechanism_.elements_[e];
      result.deflection[e] = reduced_[e] * y - element.offset;
      result.state[e] = element.law->at(result.deflection[e]);
    }
  }

  [[nodiscard]] Eigen::VectorXd unbalanced(const Equilibrium& at) const {
    Eigen::VectorXd rest = -basis_.transpose() * load_;
    for (std::size_t e = 0; e < reduced_.size(); ++e) rest += reduced_[e].transpose() * at.state[e].force;
    return rest;
  }

  double residual(Equilibrium& at) const {
    double size = (basis_.cwiseAbs().transpose() * load_.cwiseAbs()).maxCoeff();
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      size = std::max(size, (reduced_[e].cwiseAbs().transpose() * at.state[e].force.cwiseAbs()).maxCoeff());
    const double rest = unbalanced(at).cwiseAbs().maxCoeff();
    at.residual_relative = rest == 0 ? 0 : rest / size;
    if (!std::isfinite(at.residual_relative))
      throw SolverError(fmt::format(
          "a force of the equilibrium is not a finite number: {:g} N are unbalanced, the largest force is {:g} N", rest,
          size));
    return at.residual_relative;
  }

  /// One step, as far along its direction as the potential falls.
  void step(Eigen::VectorXd& y, Equilibrium& at) const {
    // A body without contact has no stiffness of its own, and may not fly away on what rounding leaves.
    constexpr double of_contact = 1e-10, farthest = 1e-4;
    Eigen::MatrixXd tangent = of_contact * Eigen::MatrixXd(in_contact_.diagonal().asDiagonal());
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      tangent += reduced_[e].transpose() * at.state[e].tangent * reduced_[e];
    const Eigen::VectorXd gradient = unbalanced(at), from = y;
    Eigen::VectorXd direction = -tangent.ldlt().solve(gradient);
    const double most = std::max(2 * y.cwiseAbs().maxCoeff(), farthest * mechanism_.length_);
    if (const double reach = direction.cwiseAbs().maxCoeff(); reach > most) direction *= most / reach;
    const double slope = gradient.dot(direction);
    const auto slope_at = [&](double s) {
      y = from + s * direction;
      evaluate(y, at);
      return unbalanced(at).dot(direction);
    };
    double end = slope_at(1);
    if (end <= 0.5 * std::abs(slope)) return;
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      end = slope_at(middle);
      if (std::abs(end) <= 0.1 * std::abs(slope)) return;
      (end > 0 ? high : low) = middle;
    }
  }

  /// What the holds bear, from what the elements leave of the loads.
  void find_holding(Equilibrium& result) const {
    const Eigen::Index count = std::ssize(mechanism_.holds_);
    result.holding = Eigen::VectorXd::Zero(count);
    if (count == 0) return;
    Eigen::VectorXd rest = load_;
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      rest -= mechanism_.elements_[e].measures.transpose() * result.state[e].force;
    Eigen::MatrixXd rows(count, mechanism_.size());
    for (Eigen::Index r = 0; r < count; ++r) rows.row(r) = mechanism_.holds_[static_cast<std::size_t>(r)];
    const Eigen::MatrixXd columns = free_.transpose() * rows.transpose();
    result.holding = columns.colPivHouseholderQr().solve(free_.transpose() * rest);
  }

  const Mechanism& mechanism_;
  Eigen::VectorXd scale_, load_;
  Eigen::MatrixXd free_;                  // of the motions that exist
  Eigen::MatrixXd basis_;                 // of those that are not held
  std::vector<Eigen::MatrixXd> reduced_;  // measures of the elements x basis
  Eigen::MatrixXd in_contact_;
};

void Mechanism::check() const { (void)Solver(*this); }

Mechanism::Equilibrium Mechanism::solve(const Eigen::VectorXd& start) const { return Solver(*this).solve(start); }

}  // namespace annulus::dynamics
