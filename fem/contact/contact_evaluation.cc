#include "fem/contact/contact_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

Eigen::VectorXd support_motion(const ContactBodies& bodies, const ComplementaritySolution& solution) {
  Eigen::VectorXd motion = solution.rigid.tail(bodies.supports->rigid_motions());
  motion.tail(motion.size() - 2) /= bodies.face.flanks().pair().wheel().reference_radius();
  return motion;
}

ContactForces port_forces(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                          const ComplementaritySolution& solution) {
  ContactForces result;
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const Eigen::VectorXd force = solution.force.segment(setup.start[i], p.size());
    if ((force.array() == 0).all()) continue;
    result.planet.push_back({p.index, bodies.planet.port_weights(p.planet) * force});
    result.wheel.push_back(
        {wheel_tooth(bodies.face.flanks(), p.index, cycle), bodies.wheel.port_weights(p.wheel) * force});
  }
  if (bodies.supports != nullptr) {
    result.supports = solution.force.tail(bodies.supports->size());
    result.rigid = support_motion(bodies, solution);
  }
  return result;
}

LoadedPosition evaluate(const ContactBodies& bodies, const ToothPairs& setup, const ComplementarityProblem& problem,
                        const ComplementaritySolution& solution) {
  const auto& pairs = setup.pairs;
  const double load = setup.load;
  LoadedPosition result;
  result.load = load;
  result.entry.lte = solution.rigid[0];
  double unloaded = pairs.front().smallest_gap;
  for (const auto& p : pairs) unloaded = std::min(unloaded, p.smallest_gap);
  result.entry.unloaded_te = unloaded;
  if (!(result.entry.lte > unloaded))
    throw SolverError(
        fmt::format("the loaded transmission error, {:.4g} m, does not exceed the unloaded one, {:.4g} m, "
                    "under {:.4g} N",
                    result.entry.lte, unloaded, load));
  result.entry.stiffness_secant = load / (result.entry.lte - unloaded);
  result.entry.stiffness_tangent = 1 / solution.tangent(0, 0);

  double moment = 0;
  const auto& z = bodies.face.slice_edges();
  result.line_load.assign(bodies.planet.slices(), 0.0);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    const Eigen::VectorXd force = solution.force.segment(at, p.size());
    moment -= (bodies.planet.resultants(p.planet, p.index).col(2)).dot(force);
    result.pair_share.push_back(bodies.face.normal_factor() * force.sum() / load);
    result.pair_roll.push_back(p.roll);
    for (Eigen::Index e = 0; e < p.size(); ++e) {
      if (force[e] <= 0) continue;
      const auto& element = p.elements[e];
      const int s = p.planet.elements[e].slice;
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
  const double against_gaps = solution.force.dot(problem.gap), work = load * result.entry.lte;
  // A crooked lead can make the transmission error, and with it the work, nothing or negative; the energy is neither.
  result.energy_balance_relative = std::abs(work - stored - against_gaps) / std::max(std::abs(work), stored);
  result.max_penetration = std::max(0.0, -solution.gap.minCoeff());
  if (bodies.supports != nullptr) bodies.supports->fill_states(solution.force.tail(bodies.supports->size()), result);
  return result;
}

}  // namespace annulus::fem
