#include "fem/contact/contact_evaluation.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/contact/planet_on_rollers.h"

namespace annulus::fem {

std::vector<FloatingUnknowns> floating_unknowns(const ContactBodies& bodies, Eigen::Index contacts) {
  const auto& pair = bodies.face.flanks().pair();
  std::vector<FloatingUnknowns> list;
  Eigen::Index force = contacts, motion = 1;
  const auto add = [&](const SupportRow& row, double radius) {
    list.push_back({&row, force, motion, radius});
    force += row.unknowns();
    motion += row.rigid_motions();
  };
  if (bodies.supports != nullptr) add(*bodies.supports, pair.wheel().reference_radius());
  if (bodies.rollers != nullptr) add(bodies.rollers->row(), pair.pinion().reference_radius());
  return list;
}

Eigen::VectorXd support_motion(const FloatingUnknowns& body, const ComplementaritySolution& solution) {
  Eigen::VectorXd motion = solution.rigid.segment(body.motion, body.row->rigid_motions());
  motion.tail(motion.size() - 2) /= body.radius;
  return motion;
}

double pinion_angle(const ContactBodies& bodies, const ToothPairs& setup) {
  const auto& first = setup.pairs.front();
  const auto& flanks = bodies.face.flanks();
  return flanks.pinion_tooth_angle(first.roll) - first.index * flanks.pair().pinion().pitch_angle();
}

Eigen::VectorXd applied_forces(const ContactBodies& bodies, const ToothPairs& setup) {
  return setup.load * bodies.rollers->partner_forces(pinion_angle(bodies, setup));
}

Eigen::VectorXd row_forces(const ContactBodies& bodies, const ToothPairs& setup, const FloatingUnknowns& body,
                           const ComplementaritySolution& solution) {
  Eigen::VectorXd forces(body.row->size());
  forces.head(body.row->unknowns()) = solution.force.segment(body.force, body.row->unknowns());
  if (body.row != bodies.supports) forces.tail(forces.size() - body.row->unknowns()) = applied_forces(bodies, setup);
  return forces;
}

ContactForces port_forces(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                          const ComplementaritySolution& solution) {
  ContactForces result;
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const Eigen::VectorXd force = solution.force.segment(setup.start[i], p.size());
    if ((force.array() == 0).all()) continue;
    result.pinion.push_back({p.index, bodies.pinion.port_weights(p.pinion) * force});
    result.wheel.push_back(
        {wheel_tooth(bodies.face.flanks(), p.index, cycle), bodies.wheel.port_weights(p.wheel) * force});
  }
  for (const auto& body : floating_unknowns(bodies, setup.contacts)) {
    const bool wheel = body.row == bodies.supports;
    (wheel ? result.supports : result.rollers) = row_forces(bodies, setup, body, solution);
    (wheel ? result.rigid : result.pinion_rigid) = support_motion(body, solution);
  }
  return result;
}

namespace {

/// What changes with the loads of a planet's two meshes. Displacements by the other mesh are gaps, and its resultants
/// loads of the rigid motions.
struct ChangeWithLoad {
  Eigen::VectorXd force;          ///< N/N
  double transmission_error = 0;  ///< m/N
};
ChangeWithLoad change_with_load(const ToothPairs& setup, const ComplementarityProblem& problem,
                                const ComplementaritySolution& solution, double own, double other) {
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < solution.force.size(); ++i)
    if (solution.active[static_cast<std::size_t>(i)]) active.push_back(i);
  const auto n = static_cast<Eigen::Index>(active.size()), motions = problem.rigid.cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + motions, n + motions);
  Eigen::VectorXd change(n + motions);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) matrix(i, j) = problem.compliance(active[i], active[j]);
    matrix.row(i).tail(motions) = -problem.rigid.row(active[i]);
    change[i] = -other * problem.applied_gap[active[i]] / setup.load;
  }
  matrix.bottomLeftCorner(motions, n) = matrix.topRightCorner(n, motions).transpose();
  change.tail(motions) = -other * problem.load / setup.load;
  change[n] = -own * problem.load[0] / setup.load;
  // Compliances and lever arms differ by ten orders of magnitude.
  const double scale = problem.compliance.diagonal().cwiseAbs().maxCoeff();
  matrix.topLeftCorner(n, n) /= scale;
  change.head(n) /= scale;
  const Eigen::VectorXd solved = matrix.partialPivLu().solve(change);
  ChangeWithLoad result{Eigen::VectorXd::Zero(solution.force.size()), scale * solved[n]};
  for (Eigen::Index i = 0; i < n; ++i) result.force[active[static_cast<std::size_t>(i)]] = solved[i];
  return result;
}

}  // namespace

LoadedPosition evaluate(const ContactBodies& bodies, const ToothPairs& setup, const ComplementarityProblem& problem,
                        const ComplementaritySolution& solution) {
  const auto& pairs = setup.pairs;
  const double load = setup.load;
  LoadedPosition result;
  result.load = load;
  result.entry.lte = solution.rigid[0];
  double compliance = solution.tangent(0, 0);
  const auto floating = floating_unknowns(bodies, setup.contacts);
  if (bodies.rollers != nullptr) {
    const auto& pinion = floating.back();
    const auto forces = row_forces(bodies, setup, pinion, solution);
    std::vector<PlanetOnRollers::Change> changes = {{1, 1}, {0, 1}};  // of both meshes, and of the other one alone
    std::vector<double> compliances;
    for (auto& [own, other, row_change] : changes) {
      const auto change = change_with_load(setup, problem, solution, own, other);
      compliances.push_back(change.transmission_error);
      row_change = other * forces / load;  // those applied rise with the load of the other mesh
      row_change.head(pinion.row->unknowns()) = change.force.segment(pinion.force, pinion.row->unknowns());
    }
    const auto bearing = bodies.rollers->bearing_motion(load, forces, changes);
    result.entry.lte -= bearing.transmission_error;
    compliance = compliances[0] - bearing.slopes[0];
    result.partner_compliance = compliances[1] - bearing.slopes[1];
    if (!(compliance > 0))
      throw InputError(fmt::format(
          "under {:.4g} N the rollers of the planet, with {:.4g} um of radial clearance, carry over so little "
          "of the bore that a round rim would give way more than this one: reduce the clearance of the "
          "planets' bearings, raise the load, or let the planets stand on a hub",
          load, 2e6 * bodies.rollers->play()));
  }
  double unloaded = pairs.front().smallest_gap;
  for (const auto& p : pairs) unloaded = std::min(unloaded, p.smallest_gap);
  result.entry.unloaded_te = unloaded;
  if (!(result.entry.lte > unloaded))
    throw SolverError(
        fmt::format("the loaded transmission error, {:.4g} m, does not exceed the unloaded one, {:.4g} m, "
                    "under {:.4g} N",
                    result.entry.lte, unloaded, load));
  result.entry.stiffness_secant = load / (result.entry.lte - unloaded);
  result.entry.stiffness_tangent = 1 / compliance;

  double moment = 0;
  const auto& z = bodies.face.slice_edges();
  result.line_load.assign(bodies.pinion.slices(), 0.0);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    const Eigen::VectorXd force = solution.force.segment(at, p.size());
    moment -= (bodies.pinion.resultants(p.pinion, p.index).col(2)).dot(force);
    result.pair_share.push_back(bodies.face.normal_factor() * force.sum() / load);
    result.pair_roll.push_back(p.roll);
    for (Eigen::Index e = 0; e < p.size(); ++e) {
      if (force[e] <= 0) continue;
      const auto& element = p.elements[e];
      const int s = p.pinion.elements[e].slice;
      const double length = z[s + 1] - z[s], pressure = force[e] / element.area;
      result.line_load[s] += bodies.face.normal_factor() * force[e] / length;
      result.pressure.push_back({static_cast<int>(i), z[s], z[s + 1], element.roll_low, element.roll_high, pressure});
      if (pressure <= result.max_pressure) continue;
      result.max_pressure = pressure;
      result.tip_edge_contact = element.tip_edge;
    }
    at += p.size();
  }
  result.face_load_factor =
      *std::max_element(result.line_load.begin(), result.line_load.end()) / (load / bodies.face.width());
  const double torque = load * bodies.face.flanks().pair().pinion().base_radius();
  result.force_balance_relative = std::abs(moment - torque) / torque;
  const double stored = solution.force.dot(problem.compliance * solution.force);
  const double against_gaps = solution.force.dot(problem.gap), work = problem.load.dot(solution.rigid);
  // A crooked lead can make the transmission error, and with it the work, nothing or negative; the energy is neither.
  result.energy_balance_relative = std::abs(work - stored - against_gaps) / std::max(std::abs(work), stored);
  result.max_penetration = std::max(0.0, -solution.gap.minCoeff());
  for (const auto& body : floating) {
    const auto forces = row_forces(bodies, setup, body, solution);
    if (body.row == bodies.supports)
      body.row->fill_states(forces, result);
    else
      result.rollers = body.row->site_forces(forces);
  }
  return result;
}

}  // namespace annulus::fem
