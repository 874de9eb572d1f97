#include "fem/closed_form/closed_form_mesh.h"

#include <fmt/format.h>
#include "fem/closed_form/closed_form_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/stopwatch.h"
#include "fem/closed_form/tooth_contacts.h"
#include "fem/condensation/lapack.h"
#include "fem/problem/problem_check.h"

namespace annulus::fem {
namespace {

bool on_own_supports(const LoadedMeshProblem& problem) {
  return problem.pair.internal() && on_single_supports(problem.structure);
}

/// A ring on its own supports is solved twice: what 0.025 root pitches less in the layer that stands for the teeth make
/// of an entry is its error by the bending rim.
RimModel softer(const RimModel& rim) { return {rim.theory, rim.tooth_band - 0.025}; }

/// By how much that error is larger than what the layer makes of it: a rim thinner than its teeth is no beam.
double thin_rim_factor(const LoadedMeshProblem& problem) {
  const auto& gear = problem.pair.wheel();
  const double rim = problem.wheel_support_radius - gear.root_radius();
  return std::max(1.0, std::pow(gear.parameters().module / rim, 2));
}

/// Both bodies and all positions.
class ClosedFormRun {
 public:
  ClosedFormRun(const LoadedMeshProblem& problem, const RimModel& rim)
      : problem_(problem),
        flanks_(problem.pair),
        supports_(ring_supports(problem.structure, problem.wheel_support_radius,
                                problem.face_width + problem.wheel_overhang.total(), problem.pair.wheel().teeth(),
                                problem.materials.wheel)),
        pinion_(flanks_.pinion(), problem.pinion_bore_radius, problem.face_width, problem.materials.pinion, {}, rim,
                neighbours),
        wheel_(flanks_.wheel(), problem.wheel_support_radius, problem.face_width, problem.materials.wheel, supports_,
               rim, neighbours) {}

  [[nodiscard]] const std::vector<RingSupport>& supports() const { return supports_; }

  [[nodiscard]] std::vector<LoadedPosition> solve(int cycles, const LoadedMeshSettings& settings) const {
    const int loads = static_cast<int>(problem_.loads.size()), phases = problem_.phases;
    std::vector<LoadedPosition> positions(static_cast<std::size_t>(cycles * phases + 1) * loads);
    for (int phase = 0; phase <= phases; ++phase) {
      const ToothContacts contacts = find_contacts(flanks_, pinion_, wheel_, problem_.materials, problem_.face_width,
                                                   static_cast<double>(phase) / phases);
      for (int load = 0; load < loads; ++load) {
        std::vector<bool> start;  // the supports of the cycle before
        for (int cycle = phase == phases ? cycles - 1 : 0; cycle < cycles; ++cycle)
          check_deflection(problem_, settings,
                           positions[static_cast<std::size_t>(cycle * phases + phase) * loads + load] =
                               solve_position(contacts, cycle, load, start));
      }
      if (settings.progress) settings.progress(static_cast<double>(phase + 1) / (phases + 1));
    }
    check_rise(problem_, positions);
    return positions;
  }

 private:
  static constexpr int neighbours = 6;  // teeth: pairs farther apart do not touch at once

  [[nodiscard]] LoadedPosition solve_position(const ToothContacts& contacts, int cycle, int load_index,
                                              std::vector<bool>& start) const;
  void add_supports(const Eigen::VectorXd& force, LoadedPosition& position) const;

  const LoadedMeshProblem& problem_;
  FlankContact flanks_;
  std::vector<RingSupport> supports_;
  ClosedFormBody pinion_, wheel_;
};

LoadedPosition ClosedFormRun::solve_position(const ToothContacts& contacts, int cycle, int load_index,
                                             std::vector<bool>& start) const {
  const double load = problem_.loads[load_index];
  const auto forces = solve_contacts(flanks_, contacts, pinion_, wheel_, supports_, cycle, load, start);
  const auto& solution = forces.solution;
  start = solution.active;

  LoadedPosition position;
  position.mesh_phase = contacts.phase;
  position.ring_tooth = cycle;
  position.load = load;
  position.reciprocity_relative = contacts.asymmetry;
  const auto& first = contacts.pairs.front();
  position.ring_angle = pitch_point_angle(flanks_, first.index, first.roll, cycle);

  double unloaded = first.gap, moment = 0;
  const auto pairs = static_cast<Eigen::Index>(contacts.pairs.size());
  // Deflections with the line contacts as they are, not as linearised.
  const auto& linear = forces.problem;
  Eigen::VectorXd deflection = linear.compliance * solution.force, own_gap = linear.gap;
  deflection.head(pairs) +=
      (contacts.compliance - linear.compliance.topLeftCorner(pairs, pairs)) * solution.force.head(pairs);
  for (Eigen::Index i = 0; i < pairs; ++i) {
    const auto& pair = contacts.pairs[i];
    const double force = solution.force[i];
    own_gap[i] = pair.gap + forces.lines[i].approach;
    unloaded = std::min(unloaded, pair.gap);
    position.pair_share.push_back(force / load);
    position.pair_roll.push_back(pair.roll);
    // The force is normal to the pinion's involute: its lever arm is the base radius.
    const auto& root = pair.pinion_root;
    moment += force * (root.z() + root.y() * centroid_radius(pinion_.tooth().root_radius(),
                                                             pinion_.tooth().root_half_angle(), Spread::uniform));
    if (force <= 0) continue;
    const double pressure = pair.line.peak_pressure(forces.lines[i], force);
    if (pressure <= position.max_pressure) continue;
    position.max_pressure = pressure;
    position.tip_edge_contact = forces.lines[i].at_tip_edge;
  }
  position.entry.lte = solution.rigid[0];
  position.entry.unloaded_te = unloaded;
  if (!(position.entry.lte > unloaded))
    throw SolverError(fmt::format(
        "the loaded transmission error, {:.4g} m, does not exceed the unloaded one, {:.4g} m, under {:.4g} N",
        position.entry.lte, unloaded, load));
  position.entry.stiffness_secant = load / (position.entry.lte - unloaded);
  position.entry.stiffness_tangent = 1 / solution.tangent(0, 0);

  const double torque = load * problem_.pair.pinion().base_radius();
  position.force_balance_relative = std::abs(std::abs(moment) - torque) / torque;
  const Eigen::VectorXd gap = deflection + own_gap - linear.rigid * solution.rigid;
  const double work_of_gaps = solution.force.dot(own_gap), work = load * position.entry.lte;
  position.energy_balance_relative = std::abs(work - solution.force.dot(deflection) - work_of_gaps) / work;
  position.max_penetration = std::max(0.0, -gap.minCoeff());
  position.line_load = {load / problem_.face_width};
  if (static_cast<std::size_t>(load_index) == problem_.loads.size() / 2)
    for (Eigen::Index i = 0; i < pairs; ++i) {
      const auto& pair = contacts.pairs[i];
      const double force = solution.force[i];
      if (force <= 0) continue;
      const auto& line = forces.lines[i];
      const double half = line.half_width, roll_by_arc = problem_.pair.pinion().base_radius() / pair.nearest_roll;
      position.pressure.push_back(
          {static_cast<int>(i), 0, problem_.face_width, pair.nearest_roll + (line.middle - half) * roll_by_arc,
           pair.nearest_roll + (line.middle + half) * roll_by_arc, force / (2 * half * problem_.face_width)});
    }
  add_supports(solution.force.tail(solution.force.size() - pairs), position);
  return position;
}

void ClosedFormRun::add_supports(const Eigen::VectorXd& force, LoadedPosition& position) const {
  // Two supports belong to each pin or spline tooth; the bore's, which follow, are not pins.
  const auto count = static_cast<std::size_t>(problem_.structure.single_supports());
  for (std::size_t q = 0; q < count; ++q) {
    PinState state;
    for (const std::size_t i : {2 * q, 2 * q + 1}) {
      // The support feels the opposite of what it does to the rim; mirrored frame: tangential forces change sign twice.
      const double f = force[static_cast<Eigen::Index>(i)];
      state.radial_force += f * supports_[i].inwards;
      state.tangential_force += f * supports_[i].tangential;
    }
    // A bolt never lifts off; of a pin the radial direction decides, of a spline tooth either flank.
    for (const std::size_t i : {2 * q, 2 * q + 1})
      if (supports_[i].unilateral ? force[static_cast<Eigen::Index>(i)] > 0 : supports_[i].inwards == 1)
        state.touching = true;
    position.pins.push_back(state);
  }
}

/// Errors of the stiffness at every position by the bending rim of a ring on its own supports.
std::vector<double> bending_errors(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                   const RimModel& rim, int cycles, const std::vector<LoadedPosition>& positions) {
  std::vector<double> errors(positions.size(), 0.0);
  if (!on_own_supports(problem)) return errors;
  LoadedMeshSettings unlimited = settings;
  unlimited.progress = nullptr;
  unlimited.largest_deflection = std::numeric_limits<double>::infinity();
  const auto others = ClosedFormRun(problem, softer(rim)).solve(cycles, unlimited);
  const double factor = thin_rim_factor(problem);
  for (std::size_t i = 0; i < positions.size(); ++i)
    errors[i] = factor * std::abs(others[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
  return errors;
}

}  // namespace

LoadedMeshResult solve_closed_form(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                   const RimModel& rim) {
  check_problem(problem, Fidelity::closed_form);
  lapack::use_one_thread();  // thousands of small systems: threads would wait for each other more than they work
  const Stopwatch watch;
  const int cycles = problem.structure.repeating_teeth(problem.pair.wheel().teeth());
  const int loads = static_cast<int>(problem.loads.size());
  const ClosedFormRun run(problem, rim);
  const double condensed = watch.seconds();
  auto positions = run.solve(cycles, settings);
  const auto yielding = bending_errors(problem, settings, rim, cycles, positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    StiffnessEntry& entry = positions[i].entry;
    entry.error_parts.model = least_closed_form_error + yielding[i] + model_error(problem, Fidelity::closed_form);
    entry.error_relative = entry.error_parts.total();
  }

  LoadedMeshResult result = tabulated(problem, std::move(positions));
  result.level = 0;
  for (std::size_t i = 0; i < result.positions.size(); ++i)
    if (i % loads == static_cast<std::size_t>(loads) / 2)
      result.worst_error_relative =
          std::max(result.worst_error_relative,
                   result.positions[i].entry.error_relative - model_error(problem, Fidelity::closed_form));
  if (!run.supports().empty()) result.pin_stiffness = run.supports().front().stiffness;
  // The frame of the solve is the mirror image of the real ring.
  for (int pin = 0; pin < problem.structure.single_supports(); ++pin)
    result.pin_angles.push_back(-run.supports()[2 * static_cast<std::size_t>(pin)].angle);
  result.slice_edges = {0, problem.face_width};
  result.condense_seconds = condensed;
  result.contact_seconds = watch.seconds() - condensed;
  return result;
}

double closed_form_error(const LoadedMeshProblem& problem) {
  if (!on_own_supports(problem)) return least_closed_form_error;
  LoadedMeshProblem coarse = problem;
  coarse.phases = std::min(problem.phases, 16);
  coarse.loads = {problem.loads[problem.loads.size() / 2]};
  try {
    return solve_closed_form(coarse, {}).worst_error_relative;
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();
  }
}

LoadedMeshResult solve_closed_form(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings) {
  return solve_closed_form(problem, settings, {});
}

}  // namespace annulus::fem
