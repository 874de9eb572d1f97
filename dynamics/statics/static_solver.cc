#include "dynamics/statics/static_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

namespace {

using Contact = LumpedSystem::Contact;

/// Contact state of a deflection, and its distance (m) from the edge of the state `held`.
std::pair<Contact, double> wanted_state(double delta, double half_backlash, Contact held) {
  Contact contact = Contact::open;
  if (delta > half_backlash) contact = Contact::drive;
  if (delta < -half_backlash) contact = Contact::back;
  const double edge = (held == Contact::back || contact == Contact::back) ? -half_backlash : half_backlash;
  return {contact, contact == held ? 0.0 : std::abs(delta - edge)};
}

// A mesh without contact retains a billionth of its stiffness, so that an unloaded body has a definite position. Its
// spring is then anchored there and pulls no more: 1e-9 k x half backlash may be more than a light load.
constexpr double open_share = 1e-9;

bool is_open(const LumpedSystem& system, int mesh, const LumpedSystem::Workspace& w) {
  return system.meshes()[mesh].half_backlash.value_or(0.0) != 0 && w.contact[mesh] == Contact::open;
}

/// K with its rigid motions fixed.
Eigen::MatrixXd fixed_stiffness(const LumpedSystem& system, const Eigen::VectorXd& mean) {
  Eigen::MatrixXd stiffness = system.stiffness();
  const Modes found = modes(system, mean);
  for (const auto& mode : found.modes) {
    if (mode.frequency > 0) break;
    const double work = std::abs(mode.shape.dot(system.load()));
    // A balanced load cancels to rounding: some 1e-16 of the terms.
    if (work > 1e-9 * mode.shape.cwiseAbs().dot(system.load().cwiseAbs())) refuse_unbalanced(system, mode.shape);
    const Eigen::VectorXd momentum = system.mass() * mode.shape;
    // As stiff as the meshes: stiffer, it would drown them in rounding.
    stiffness += mean.maxCoeff() / momentum.cwiseAbs2().maxCoeff() * momentum * momentum.transpose();
  }
  return stiffness;
}

}  // namespace

StaticSolver::StaticSolver(const LumpedSystem& system) : StaticSolver(system, mean_stiffnesses(system)) {}

StaticSolver::StaticSolver(const LumpedSystem& system, const Eigen::VectorXd& mean)
    : system_(system),
      stiffness_(fixed_stiffness(system, mean), system.mesh_vectors(), mean),
      stiffness_size_(stiffness_.stiffness().cwiseAbs()),
      vectors_size_(stiffness_.vectors().cwiseAbs()) {
  const auto meshes = stiffness_.vectors().cols();
  rest_ = Eigen::VectorXd::Zero(system.dofs());
  forces_.resize(meshes);
  anchor_ = Eigen::VectorXd::Zero(meshes);
}

void StaticSolver::set_tangent(const LumpedSystem::Workspace& w) {
  system_.tangent_matrix(w, tangent_);
  for (int m = 0; m < forces_.size(); ++m)
    if (is_open(system_, m, w)) tangent_(m, m) += open_share * w.stiffness[m];
}

void StaticSolver::factorise(const Eigen::MatrixXd& tangent, double t) {
  if (!stiffness_.factorise(tangent))
    throw SolverError(fmt::format(
        "the quasi-static stiffness at t = {:g} s is not positive: a degree of freedom has no support, or a "
        "coupling subtracts more compliance from the meshes than they have",
        t));
}

double StaticSolver::residual(double t, const Eigen::VectorXd& q, LumpedSystem::Workspace& w) {
  system_.evaluate_meshes(t, q.data(), rest_.data(), w);
  for (int m = 0; m < forces_.size(); ++m) {
    w.delta_rate[m] = 0;
    w.force[m] = forces_[m] = w.elastic[m];
    if (is_open(system_, m, w)) forces_[m] += open_share * w.stiffness[m] * (w.approach[m] - anchor_[m]);
  }
  const auto& vectors = stiffness_.vectors();
  residual_ = load_;
  residual_.noalias() -= stiffness_.stiffness() * q;
  residual_.noalias() -= vectors * forces_;
  // A force carries the rounding of the motions and errors it is the difference of.
  const Eigen::VectorXd size = q.cwiseAbs();
  Eigen::VectorXd sizes = vectors_size_.transpose() * size;
  for (int m = 0; m < forces_.size(); ++m)
    sizes[m] = std::abs(forces_[m]) +
               w.stiffness[m] * (sizes[m] + std::abs(w.error[m]) + system_.meshes()[m].half_backlash.value_or(0.0));
  terms_ = load_.cwiseAbs();
  terms_.noalias() += stiffness_size_ * size;
  terms_.noalias() += vectors_size_ * sizes;
  return terms_.maxCoeff();
}

void StaticSolver::iterate(double t, Eigen::VectorXd& q, LumpedSystem::Workspace& w) {
  constexpr int steps = 60;
  // Rounding of the residual is some 1e-15 of its terms; Newton's last step falls from 1e-6 to there.
  constexpr double accuracy = 1e-13;
  double scale = residual(t, q, w);
  for (int step = 0; step < steps; ++step) {
    // DOF by DOF: stiff supports must not hide what light loads do elsewhere.
    if ((residual_.array().abs() <= accuracy * terms_.array()).all()) return;
    set_tangent(w);
    factorise(tangent_, t);
    const Eigen::VectorXd direction = stiffness_.solve(residual_), from = q;
    // The potential is convex along the step: a place where its slope is no steeper than at the start is soon enclosed.
    // From within the play of a bearing, where hardly any stiffness acts, it takes some twenty halves.
    constexpr double narrowest = 1e-14;
    const double slope = direction.dot(residual_);
    double share = 1, low = 0, high = 2;
    for (;;) {
      q = from + share * direction;
      scale = residual(t, q, w);
      const double here = direction.dot(residual_);
      if (std::abs(here) <= 0.9 * slope || slope <= accuracy * scale * direction.norm()) break;
      (here > 0 ? low : high) = share;
      share = (low + high) / 2;
      if (high - low < narrowest)
        throw SolverError(fmt::format("no descent towards a static equilibrium at t = {:g} s (step {:g})", t, share));
    }
    // Where the terms cancel badly the residual stalls at rounding above the limit: a step that moves nothing ends it.
    if (direction.cwiseAbs().maxCoeff() <= 1e-13 * q.cwiseAbs().maxCoeff()) return;
  }
  throw SolverError(fmt::format("no static equilibrium in {} steps of Newton's method at t = {:g} s", steps, t));
}

Eigen::VectorXd StaticSolver::solve(double t, LumpedSystem::Workspace& w) {
  system_.evaluate_excitation(t, w);
  load_ = system_.load_at(t);
  Eigen::VectorXd q = equilibrium(t, w);
  if (!system_.has_friction()) return q;
  // Each time the change is smaller by a few coefficients of friction.
  constexpr int tries = 60;
  constexpr double accuracy = 1e-13;
  const Eigen::VectorXd without = load_;
  for (int i = 0; i < tries; ++i) {
    const Eigen::VectorXd before = load_;
    load_ = without + system_.friction_force(w);
    const double change = (load_ - before).lpNorm<Eigen::Infinity>();
    if (change <= accuracy * load_.lpNorm<Eigen::Infinity>()) return q;
    q = equilibrium(t, w);
  }
  throw SolverError(fmt::format("no static equilibrium with friction in {} steps at t = {:g} s", tries, t));
}

Eigen::VectorXd StaticSolver::equilibrium(double t, LumpedSystem::Workspace& w) {
  const int meshes = static_cast<int>(forces_.size());
  if (system_.has_moving_vectors()) {
    stiffness_.set_vectors(system_.mesh_vectors(t));
    vectors_size_ = stiffness_.vectors().cwiseAbs();
  }
  const auto half = [&](int m) { return system_.meshes()[m].half_backlash.value_or(0.0); };
  constexpr int tries = 200, all_at_once = 20;
  // The linear solution with the stiffnesses in the workspace: the equilibrium itself for linear meshes, near it for a
  // law that carries about its nominal load.
  Eigen::VectorXd q = Eigen::VectorXd::Zero(system_.dofs());
  tangent_.setZero(meshes, meshes);
  Eigen::VectorXd load = load_;
  anchor_.setZero();
  int anchored = 0;
  for (int m = 0; m < meshes; ++m) {
    const double offset = half(m) == 0 ? 0.0 : static_cast<int>(w.contact[m]) * half(m);
    tangent_(m, m) = (is_open(system_, m, w) ? open_share : 1.0) * w.stiffness[m];
    load += tangent_(m, m) * (w.error[m] + offset) * stiffness_.vectors().col(m);
  }
  factorise(tangent_, t);
  q = stiffness_.solve(load);
  for (int attempt = 0; attempt < tries; ++attempt) {
    iterate(t, q, w);
    int changes = 0, worst = -1;
    double worst_excess = 0;
    for (int m = 0; m < meshes; ++m) {
      if (half(m) == 0) continue;
      const auto [contact, excess] = wanted_state(w.delta[m], half(m), w.contact[m]);
      if (contact == w.contact[m]) continue;
      ++changes;
      if (excess > worst_excess) {
        worst_excess = excess;
        worst = m;
      }
      if (attempt < all_at_once) w.contact[m] = contact;
    }
    if (changes == 0) {
      // Anchored once, the springs pull with a billionth of a billionth; again where that changed contacts.
      constexpr double unseen = 1e-12;
      constexpr int enough = 20;
      double pull = 0;
      for (int m = 0; m < meshes; ++m)
        if (is_open(system_, m, w)) {
          pull = std::max(pull, std::abs(open_share * w.stiffness[m] * (w.approach[m] - anchor_[m])));
          anchor_[m] = w.approach[m];
        }
      if (pull <= unseen * load_.lpNorm<Eigen::Infinity>() || anchored++ == enough) return q;
      continue;
    }
    // Changing all at once is fast but may cycle; one at a time, the worst first, ends it.
    if (attempt >= all_at_once) {
      if (worst < 0) return q;  // all differ by rounding only: on the edge either state is right
      w.contact[worst] = wanted_state(w.delta[worst], half(worst), w.contact[worst]).first;
    }
  }
  throw SolverError(fmt::format("no consistent contact state in {} attempts at t = {:g} s (quasi-static)", tries, t));
}

Eigen::MatrixXd StaticSolver::force_per_error(const LumpedSystem::Workspace& w) {
  set_tangent(w);
  factorise(tangent_, w.time);
  const auto& vectors = stiffness_.vectors();
  return tangent_ * vectors.transpose() * stiffness_.solve(vectors * tangent_) - tangent_;
}

StaticPath static_path(const LumpedSystem& system, const Eigen::VectorXd& times) {
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  StaticPath path{Eigen::MatrixXd(system.dofs(), times.size()), Eigen::MatrixXd(meshes, times.size())};
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    path.displacement.col(i) = solver.solve(times[i], workspace);
    path.force.col(i) = Eigen::Map<const Eigen::VectorXd>(workspace.force.data(), meshes);
  }
  return path;
}

}  // namespace annulus::dynamics
