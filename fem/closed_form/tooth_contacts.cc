#include "fem/closed_form/tooth_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/contact/pair_search.h"

namespace annulus::fem {
namespace {

/// In base pitches: flanks that overlap less have no room for a contact.
constexpr double shortest_overlap = 1e-9;

/// Root load of a unit force on the trailing flank from that on the leading one.
Eigen::Vector3d mirrored_root(const Eigen::Vector3d& root) { return {root.x(), -root.y(), -root.z()}; }

/// Place on the involute, arc length from the base circle, m.
double arc(const geometry::ToothProfile& profile, double roll) {
  return roll * roll / (2 * profile.gear().base_radius());
}

/// Distance along a flank from a roll length to its tip, m.
double distance_to_tip(const geometry::ToothProfile& profile, double roll) {
  return std::abs(arc(profile, profile.roll_length_tip()) - arc(profile, roll));
}

/// What the modifications of a flank add to the gap, by the arc towards growing roll lengths.
struct Modification {
  double slope = 0, curvature = 0;  ///< of profile crowning and slope
  FlankGap::Kink relief;            ///< where the tip relief starts
};

Modification modification(const geometry::ToothProfile& profile, double roll) {
  const auto& p = profile.gear().parameters();
  const double tip = profile.roll_length_tip(), form = profile.roll_length_form(), base = profile.gear().base_radius();
  const double by_arc = base / roll, length = tip - form;  // d roll / d arc
  const double slope = (4 * p.profile_crowning * (2 * (roll - form) / length - 1) + p.profile_slope) / length;
  Modification result;
  result.slope = slope * by_arc;
  result.curvature = 8 * p.profile_crowning / (length * length) * by_arc * by_arc - slope * by_arc * by_arc / roll;
  if (p.tip_relief > 0) {
    const double start = tip - std::copysign(p.tip_relief_length, length);
    result.relief = {arc(profile, start) - arc(profile, roll), p.tip_relief / p.tip_relief_length * base / start};
  }
  return result;
}

/// The gap round a pair of opposite points: its slope is the difference of the normals of two involutes.
FlankGap gap_around(const FlankContact& flanks, double pinion_roll, double wheel_roll, double roll,
                    const FlankContact::Interval& domain) {
  const auto &pinion = flanks.pinion(), &wheel = flanks.wheel();
  const double sense = flanks.pair().internal() ? 1 : -1;  // of the wheel's roll length along the pinion's flank
  const auto on_pinion = modification(pinion, pinion_roll), on_wheel = modification(wheel, wheel_roll);
  FlankGap gap;
  gap.slope = (pinion_roll - roll) / pinion.gear().base_radius() -
              (wheel_roll - flanks.pair().wheel_roll_length(roll)) / wheel.gear().base_radius() + on_pinion.slope +
              sense * on_wheel.slope;
  gap.curvature = 1 / pinion_roll - sense / wheel_roll + on_pinion.curvature + on_wheel.curvature;
  gap.low = arc(pinion, domain.low) - arc(pinion, pinion_roll);
  gap.high = arc(pinion, domain.high) - arc(pinion, pinion_roll);
  gap.kinks = {on_pinion.relief, {sense * on_wheel.relief.place, on_wheel.relief.jump}};
  gap.slope -= on_wheel.relief.jump;  // the wheel's relief is at lower x: it ends at its kink
  return gap;
}

/// Angle of the material at the tip edge: the flank leans against the radius by the pressure angle.
double tip_corner(const geometry::ToothProfile& profile) {
  return M_PI / 2 + std::atan(profile.roll_length_tip() / profile.gear().base_radius());
}

/// The flanks of a pair where they are nearest, and what a unit force does to the roots there.
FlanksApart nearest_flanks(const FlankContact& flanks, const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                           int index, double roll) {
  const double nearest = flanks.nearest_roll(roll, flanks.domain(roll));
  const auto match = flanks.match(nearest, roll);
  const auto &on_pinion = pinion.tooth().load(nearest).root, &on_wheel = wheel.tooth().load(match.wheel_roll).root;
  return {index, match.gap, on_pinion, flanks.pair().internal() ? mirrored_root(on_wheel) : on_wheel};
}

/// The nearest flanks before and behind the pairs of the contacts that still face each other.
void add_flanks_beyond(const FlankContact& flanks, const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                       const std::vector<std::pair<int, double>>& pairs, ToothContacts& contacts) {
  const double pitch = flanks.pair().pinion().base_pitch();
  for (const auto& [index, roll] : {std::pair(pairs.front().first - 1, pairs.front().second - pitch),
                                    std::pair(pairs.back().first + 1, pairs.back().second + pitch)})
    if (!flanks.domain(roll).empty()) contacts.apart.push_back(nearest_flanks(flanks, pinion, wheel, index, roll));
}

/// Adds the pair to the contacts. Behind the path of contact the tip of a pinion may pass that of a ring, against which
/// it is the flatter one: the gap is not convex there, and only its distance is used.
void add_contact(const FlankContact& flanks, const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                 const MeshMaterials& materials, double width, int index, double roll, ToothContacts& contacts) {
  const auto& pair = flanks.pair();
  const auto domain = flanks.domain(roll);
  const double nearest = flanks.nearest_roll(roll, domain);
  const auto match = flanks.match(nearest, roll);
  const auto on_pinion = pinion.tooth().load(nearest), on_wheel = wheel.tooth().load(match.wheel_roll);
  const FlankGap gap = gap_around(flanks, nearest, match.wheel_roll, roll, domain);
  if (!(gap.curvature > 0)) {
    contacts.apart.push_back(nearest_flanks(flanks, pinion, wheel, index, roll));
    return;
  }
  const double pinion_edge = distance_to_tip(flanks.pinion(), nearest);
  // The patch and the edge have to agree where the wheel's tip cuts the gap.
  const bool wheel_tip_cuts = domain.low > flanks.pinion().roll_length_form();
  const double wheel_edge =
      wheel_tip_cuts ? -gap.low : std::max(-gap.low, distance_to_tip(flanks.wheel(), match.wheel_roll));

  // How the compliance of both teeth grows along the flank, the depths of the contact included; a ring's own motions
  // turn all its flanks equally and are no part of it.
  const auto local = [&](const Material& m, double depth) {
    return 2 * (1 - m.poisson_ratio * m.poisson_ratio) / (M_PI * m.youngs_modulus * width) * std::log(depth);
  };
  const auto compliance = [&](double x) {
    const double at = std::sqrt(2 * flanks.pinion().gear().base_radius() * (arc(flanks.pinion(), nearest) + x));
    const auto p = pinion.tooth().load(at), w = wheel.tooth().load(flanks.match(at, roll).wheel_roll);
    return p.root.dot(pinion.foundation_compliance() * p.root) + w.root.dot(wheel.foundation_compliance() * w.root) +
           (p.compliance + w.compliance) / width + local(materials.pinion, p.depth) + local(materials.wheel, w.depth);
  };
  const double step = 0.02 * pair.pinion().parameters().module;
  const double from = std::max(gap.low, -step), to = std::min(gap.high, step);
  // Flanks that hardly overlap have no room to tilt.
  const double tilt = to - from > step / 2 ? (compliance(to) - compliance(from)) / (to - from) / 2 * width : 0;
  contacts.pairs.push_back(
      {index, roll, nearest, match.gap, on_pinion.root, pair.internal() ? mirrored_root(on_wheel.root) : on_wheel.root,
       (on_pinion.compliance + on_wheel.compliance) / width,
       LineContact(gap, {on_pinion.depth, pinion_edge, tip_corner(flanks.pinion())},
                   {on_wheel.depth, wheel_edge, tip_corner(flanks.wheel())}, tilt, materials, width)});
}

}  // namespace

ToothContacts find_contacts(const FlankContact& flanks, const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                            const MeshMaterials& materials, double width, double phase) {
  ToothContacts contacts;
  contacts.phase = phase;
  const auto pairs = possible_pairs(flanks, phase);
  for (const auto& [index, roll] : pairs) {
    const auto domain = flanks.domain(roll);
    if (domain.high - domain.low < shortest_overlap * flanks.pair().pinion().base_pitch()) continue;
    add_contact(flanks, pinion, wheel, materials, width, index, roll, contacts);
  }
  require(!contacts.pairs.empty(), "no tooth pair faces another");
  add_flanks_beyond(flanks, pinion, wheel, pairs, contacts);

  const auto n = static_cast<Eigen::Index>(contacts.pairs.size());
  Eigen::MatrixXd formed(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto &a = contacts.pairs[i], &b = contacts.pairs[j];
      const int wheel_offset = wheel_tooth(flanks, a.index, 0) - wheel_tooth(flanks, b.index, 0);
      formed(i, j) = a.pinion_root.dot(pinion.root_compliance(a.index - b.index) * b.pinion_root) +
                     a.wheel_root.dot(wheel.root_compliance(wheel_offset) * b.wheel_root) +
                     (i == j ? a.cantilevers : 0);
    }
  contacts.asymmetry = (formed - formed.transpose()).cwiseAbs().maxCoeff() / formed.cwiseAbs().maxCoeff();
  contacts.compliance = (formed + formed.transpose()) / 2;
  return contacts;
}

namespace {

/// m, gap that a position leaves between flanks outside the contacts; deflections of the roots alone, for nothing
/// presses on these flanks.
double gap_left(const FlankContact& flanks, const ToothContacts& contacts, const FlanksApart& apart,
                const ClosedFormBody& pinion, const ClosedFormBody& wheel, int cycle,
                const ComplementaritySolution& solution) {
  const auto pairs = static_cast<Eigen::Index>(contacts.pairs.size()), held = solution.force.size() - pairs;
  double gap = apart.gap - solution.rigid[0];
  for (Eigen::Index i = 0; i < pairs; ++i) {
    const auto& pair = contacts.pairs[i];
    const int offset = wheel_tooth(flanks, apart.index, 0) - wheel_tooth(flanks, pair.index, 0);
    gap += solution.force[i] *
           (apart.pinion_root.dot(pinion.root_compliance(apart.index - pair.index) * pair.pinion_root) +
            apart.wheel_root.dot(wheel.root_compliance(offset) * pair.wheel_root));
  }
  if (held == 0) return gap;
  const int tooth = wheel_tooth(flanks, apart.index, cycle);
  Eigen::Vector3d motion = solution.rigid.tail<3>();
  motion[2] /= flanks.pair().wheel().reference_radius();
  return gap + apart.wheel_root.dot(wheel.root_from_supports(tooth) * solution.force.tail(held)) +
         apart.wheel_root.dot(wheel.root_resultants(tooth) * motion);
}

}  // namespace

ToothContactSolution solve_contacts(const FlankContact& flanks, const ToothContacts& contacts,
                                    const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                                    const std::vector<RingSupport>& supports, int cycle, double load,
                                    const std::vector<bool>& start) {
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
      const double at = std::max(force[i], lightest);
      const auto line = pair.line.at(at);
      problem.compliance(i, i) = contacts.compliance(i, i) + line.compliance;
      problem.gap[i] = pair.gap + line.approach - line.compliance * at;
    }
    result.solution = solve_complementarity(problem, active);
    active = result.solution.active;
    const Eigen::VectorXd next = result.solution.force.head(pairs).cwiseMax(0);
    change = (next - force).cwiseAbs().maxCoeff();
    force = next;
    if (change > wanted) continue;
    for (const auto& apart : contacts.apart)
      if (gap_left(flanks, contacts, apart, pinion, wheel, cycle, result.solution) <= 0)
        throw SolverError(
            fmt::format("mesh phase {:.4f}: under {:.4g} N two tips or flanks with a gap of {:.3g} mm touch beyond the "
                        "path of contact. Formulas do not cover this: use model = \"plane\"",
                        contacts.phase, load, 1e3 * apart.gap));
    for (Eigen::Index i = 0; i < pairs; ++i)
      result.lines.push_back(force[i] > 0 ? contacts.pairs[i].line.at(force[i]) : LineContact::State{});
    return result;
  }
  throw SolverError(fmt::format("mesh phase {:.4f}: the line contacts at {:.4g} N did not settle; last change {:.3g} N",
                                contacts.phase, load, change));
}

}  // namespace annulus::fem
