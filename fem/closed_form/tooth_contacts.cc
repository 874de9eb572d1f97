#include "fem/closed_form/tooth_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Root load of a unit force on the trailing flank from that on the leading one.
Eigen::Vector3d mirrored_root(const Eigen::Vector3d& root) { return {root.x(), -root.y(), -root.z()}; }

/// Distance along a flank from a roll length to its tip, m.
double distance_to_tip(const geometry::ToothProfile& profile, double roll) {
  const double tip = profile.roll_length_tip();
  return std::abs(tip * tip - roll * roll) / (2 * profile.gear().base_radius());  // s = rho^2 / (2 r_b)
}

ToothContact make_contact(const FlankContact& flanks, const ClosedFormBody& planet, const ClosedFormBody& wheel,
                          const Material& material, double width, int index, double roll) {
  const auto& pair = flanks.pair();
  const double nearest = flanks.nearest_roll(roll);
  const auto match = flanks.match(nearest, roll);
  const auto on_planet = planet.tooth().load(nearest), on_wheel = wheel.tooth().load(match.wheel_roll);
  const double curvature = flanks.relative_curvature(std::clamp(roll, pair.roll_length_low(), pair.roll_length_high()));
  const double planet_edge = distance_to_tip(flanks.planet(), nearest);
  const double wheel_edge = distance_to_tip(flanks.wheel(), match.wheel_roll);
  return {index,
          roll,
          nearest,
          match.gap,
          std::min(planet_edge, wheel_edge),
          on_planet.root,
          pair.internal() ? mirrored_root(on_wheel.root) : on_wheel.root,
          (on_planet.compliance + on_wheel.compliance) / width,
          LineContact(curvature, {on_planet.depth, planet_edge}, {on_wheel.depth, wheel_edge}, material, width)};
}

}  // namespace

int wheel_tooth(const FlankContact& flanks, int index, int cycle) {
  return flanks.pair().internal() ? index - cycle : -(index + cycle);
}

ToothContacts find_contacts(const FlankContact& flanks, const ClosedFormBody& planet, const ClosedFormBody& wheel,
                            const Material& material, double width, double phase) {
  const auto& pair = flanks.pair();
  const double pitch = pair.planet().base_pitch();
  // In the ring mesh the planet drives and contact moves from its root to its tip; in the sun mesh the other way round.
  const double reference = pair.roll_length_pitch() + (pair.internal() ? 1 : -1) * phase * pitch;
  const int first = static_cast<int>(std::ceil((pair.roll_length_low() - reference) / pitch - 1));
  const int last = static_cast<int>(std::floor((pair.roll_length_high() - reference) / pitch + 1));
  ToothContacts contacts;
  contacts.phase = phase;
  for (int k = first; k <= last; ++k) {
    const double roll = reference + k * pitch;
    if (roll <= 0) continue;
    if (flanks.domain(roll).empty()) continue;
    contacts.pairs.push_back(make_contact(flanks, planet, wheel, material, width, k, roll));
  }
  require(!contacts.pairs.empty(), "no tooth pair faces another");

  const auto n = static_cast<Eigen::Index>(contacts.pairs.size());
  Eigen::MatrixXd formed(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto &a = contacts.pairs[i], &b = contacts.pairs[j];
      const int wheel_offset = wheel_tooth(flanks, a.index, 0) - wheel_tooth(flanks, b.index, 0);
      formed(i, j) = a.planet_root.dot(planet.root_compliance(a.index - b.index) * b.planet_root) +
                     a.wheel_root.dot(wheel.root_compliance(wheel_offset) * b.wheel_root) +
                     (i == j ? a.cantilevers : 0);
    }
  contacts.asymmetry = (formed - formed.transpose()).cwiseAbs().maxCoeff() / formed.cwiseAbs().maxCoeff();
  contacts.compliance = (formed + formed.transpose()) / 2;
  return contacts;
}

ToothContactSolution solve_contacts(const FlankContact& flanks, const ToothContacts& contacts,
                                    const ClosedFormBody& wheel, const std::vector<RingSupport>& supports, int cycle,
                                    double load, const std::vector<bool>& start) {
  const auto pairs = static_cast<Eigen::Index>(contacts.pairs.size());
  const auto held = static_cast<Eigen::Index>(supports.size());
  ToothContactSolution result;
  auto& problem = result.problem;
  problem.compliance = Eigen::MatrixXd::Zero(pairs + held, pairs + held);
  problem.rigid = Eigen::MatrixXd::Zero(pairs + held, held > 0 ? 4 : 1);
  problem.rigid.col(0).head(pairs).setOnes();
  problem.load = Eigen::VectorXd::Zero(problem.rigid.cols());
  problem.load[0] = load;
  problem.gap = Eigen::VectorXd::Zero(pairs + held);
  problem.unilateral.assign(pairs + held, true);
  problem.compliance.topLeftCorner(pairs, pairs) = contacts.compliance;
  if (held > 0) {
    problem.compliance.bottomRightCorner(held, held) = wheel.support_compliance();
    for (Eigen::Index i = 0; i < pairs; ++i) {
      const auto& pair = contacts.pairs[i];
      const int tooth = wheel_tooth(flanks, pair.index, cycle);
      problem.compliance.row(i).tail(held) = pair.wheel_root.transpose() * wheel.root_from_supports(tooth);
      problem.compliance.col(i).tail(held) = problem.compliance.row(i).tail(held).transpose();
      problem.rigid.row(i).tail<3>() = -pair.wheel_root.transpose() * wheel.root_resultants(tooth);
    }
    problem.rigid.bottomRightCorner(held, 3) = -wheel.support_resultants();
    problem.rigid.col(3) /= flanks.pair().wheel().reference_radius();  // makes the rotation a displacement
    for (Eigen::Index q = 0; q < held; ++q) {
      problem.gap[pairs + q] = supports[q].gap;
      problem.unilateral[pairs + q] = supports[q].unilateral;
    }
  }

  // Newton's method: the line contacts are replaced by their tangents, which hardly change with the force (by its
  // logarithm): four or five steps. The lightest force keeps the logarithm finite.
  const double lightest = 1e-9 * load, wanted = 1e-11 * load;
  Eigen::VectorXd force = Eigen::VectorXd::Constant(pairs, load / 2);
  std::vector<bool> active = start;
  double change = 0;
  constexpr int most = 50;
  for (int step = 0; step < most; ++step) {
    for (Eigen::Index i = 0; i < pairs; ++i) {
      const auto& pair = contacts.pairs[i];
      const double at = std::max(force[i], lightest), slope = pair.line.compliance(at);
      problem.compliance(i, i) = contacts.compliance(i, i) + slope;
      problem.gap[i] = pair.gap + pair.line.approach(at) - slope * at;
    }
    result.solution = solve_complementarity(problem, active);
    active = result.solution.active;
    const Eigen::VectorXd next = result.solution.force.head(pairs).cwiseMax(0);
    change = (next - force).cwiseAbs().maxCoeff();
    force = next;
    if (change > wanted) continue;
    result.approach.resize(pairs);
    for (Eigen::Index i = 0; i < pairs; ++i) result.approach[i] = contacts.pairs[i].line.approach(force[i]);
    return result;
  }
  throw SolverError(fmt::format("mesh phase {:.4f}: the line contacts at {:.4g} N did not settle; last change {:.3g} N",
                                contacts.phase, load, change));
}

}  // namespace annulus::fem
