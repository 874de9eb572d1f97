#include "dynamics/systems/helical_pair/pair_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "dynamics/figures/mesh_results.h"
#include "dynamics/figures/motion.h"
#include "dynamics/figures/peaks.h"
#include "dynamics/figures/window_evidence.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/system/periods.h"

namespace annulus::dynamics {

namespace {

using Row = Eigen::RowVectorXd;

Row dof_row(const LumpedSystem& system, const Eigen::MatrixXd& values, const char* name) {
  const int i = system.find(name);
  return i < 0 ? Row(Row::Zero(values.cols())) : Row(values.row(i));
}

struct MotionRows {
  Row transmission_error, relative;
};

/// From where the loaded flanks just touch.
MotionRows motion_rows(const HelicalPair& pair, const LumpedSystem& system, const Eigen::MatrixXd& displacement) {
  const double side = pair.pinion_torque > 0 ? 1 : pair.pinion_torque < 0 ? -1 : 0;
  const double touching = side * pair.half_backlash.value_or(0.0) / std::cos(pair.base_helix_angle);
  Row te = dof_row(system, displacement, "pinion_u") + dof_row(system, displacement, "wheel_u");
  te.array() -= touching;
  return {te, te + dof_row(system, displacement, "pinion_y") - dof_row(system, displacement, "wheel_y")};
}

/// Both ends of a curve, `low` of its negative, and its mean with what half of the samples change.
struct Range {
  Peak high, low;
  Figure mean;
  Range() = default;
  explicit Range(const Row& values)
      : high(peak_of(values)),
        low(peak_of(-values)),
        mean{values.mean(), std::abs(values.mean() - mean_of_half(values))} {}

 private:
  static double mean_of_half(const Row& values) {
    return values(Eigen::seqN(0, (values.size() + 1) / 2, Eigen::fix<2>)).mean();
  }
};

/// Peaks of one window, in the order of PairAccelerations; y, z, u of the gears apart from the sum.
struct WindowPeaks {
  Peak line_of_action, axial, rotation, tooth;
  Range te, relative, force;
};

Peak magnitude(const Row& values) { return peak_of(values.cwiseAbs()); }

/// From the closest times, and both sides of jumps.
Range force_range(const ResponseWindow& window) {
  Range range((window.dense_force.size() > 0 ? window.dense_force : window.force).row(0));
  for (const auto* side : {&window.force_before, &window.force_after}) {
    if (!window.jumps()) break;
    const double high = side->row(0).maxCoeff(), low = side->row(0).minCoeff();
    range.high = higher(range.high, {high, high});
    range.low = higher(range.low, {-low, -low});
  }
  return range;
}

WindowPeaks peaks_of(const HelicalPair& pair, const LumpedSystem& system, const ResponseWindow& window) {
  WindowPeaks p;
  const Eigen::MatrixXd a = accelerations(system, window.time, window.displacement, window.velocity);
  for (const bool pinion : {true, false}) {
    const Row y = dof_row(system, a, pinion ? "pinion_y" : "wheel_y");
    const Row z = dof_row(system, a, pinion ? "pinion_z" : "wheel_z");
    const Row u = dof_row(system, a, pinion ? "pinion_u" : "wheel_u");
    const Row along = pinion ? Row(u + y) : Row(u - y);
    p.line_of_action = higher(p.line_of_action, magnitude(y));
    p.axial = higher(p.axial, magnitude(z));
    p.rotation = higher(p.rotation, magnitude(u));
    p.tooth = higher(p.tooth, magnitude((along.array().square() + z.array().square()).sqrt().matrix()));
  }
  const MotionRows rows = motion_rows(pair, system, window.displacement);
  p.te = Range(rows.transmission_error);
  p.relative = Range(rows.relative);
  p.force = force_range(window);
  return p;
}

/// The peaks of the best window and those it is compared with, or bounds where only the forces are known.
class PairEvidence {
 public:
  PairEvidence(const HelicalPair& pair, const LumpedSystem& system, const SteadyResponse& found)
      : best_(peaks_of(pair, system, found.best)), force_difference_(force_difference(found, 1)) {
    for (const auto& window : compared_windows(found)) others_.push_back(peaks_of(pair, system, window));
    // b / m: acceleration per force.
    const Eigen::VectorXd b = system.mesh_vector(0).cwiseAbs();
    for (int i = 0; i < system.dofs(); ++i)
      acceleration_per_force_ = std::max(acceleration_per_force_, b[i] / system.mass()(i, i));
    motion_per_force_ = pair.static_compliance() / std::cos(pair.base_helix_angle);
  }

  [[nodiscard]] Figure of(Peak WindowPeaks::*peak, double per_force) const {
    return of([peak](const WindowPeaks& p) { return p.*peak; }, per_force);
  }
  template <class Pick>
  [[nodiscard]] Figure of(const Pick& pick, double per_force) const {
    const Peak best = pick(best_);
    Figure result = figure(best, {});
    for (const auto& other : others_) result.error += std::abs(best.refined - pick(other).refined);
    result.error += force_difference_ * per_force;
    return result;
  }
  [[nodiscard]] Figure acceleration(Peak WindowPeaks::*peak, double share = 1) const {
    return of(peak, share * acceleration_per_force_);
  }
  [[nodiscard]] MotionFigures motion(Range WindowPeaks::*range) const {
    auto mean = (best_.*range).mean;
    for (const auto& other : others_) mean.error += std::abs(mean.value - (other.*range).mean.value);
    mean.error += force_difference_ * motion_per_force_;
    return {mean, of([=](const WindowPeaks& p) { return (p.*range).high + (p.*range).low; }, 2 * motion_per_force_),
            of([=](const WindowPeaks& p) { return higher((p.*range).high, (p.*range).low); }, motion_per_force_)};
  }

 private:
  WindowPeaks best_;
  std::vector<WindowPeaks> others_;
  double force_difference_ = 0, acceleration_per_force_ = 0, motion_per_force_ = 0;
};

MotionFigures sampled_motion(const Row& row) {
  const Range range(row);
  return {range.mean, figure(range.high + range.low, {}), figure(higher(range.high, range.low), {})};
}

PairMotions quasi_static_motions(const HelicalPair& pair, const LumpedSystem& system,
                                 const SimulationOptions& options) {
  const int period = pair.error_period();
  int positions = options.samples_per_cycle;
  if (period > long_window) positions = std::min(positions, enough_samples(period));
  // Two cycles at least, so that every peak has neighbours.
  const int cycles = std::max(2, std::min(period, options.max_window_cycles));
  const int count = cycles * positions;
  const auto path =
      static_path(system, Eigen::VectorXd::LinSpaced(count, 0, count - 1) / (positions * pair.mesh_frequency()));
  const MotionRows rows = motion_rows(pair, system, path.displacement);
  return {sampled_motion(rows.transmission_error), sampled_motion(rows.relative)};
}

/// N: moves the reduced mass along the errors, or bends the mesh by them where that takes less.
double error_force(const HelicalPair& pair) {
  const double stiffness = mean_stiffness(pair.mesh);
  const auto force = [&](const ErrorWave& wave, double rate) {
    return std::abs(wave.amount) * std::min(stiffness, pair.reduced_mass() * rate * rate);
  };
  return force(pair.mesh_error, 2 * std::numbers::pi * pair.mesh_frequency()) +
         force(pair.pinion.error, pair.pinion_speed) + force(pair.wheel.error, pair.wheel_speed());
}

/// N, along the line of action: of the torques of all rotors that change.
double ripple_force(const HelicalPair& pair) {
  double force = 0;
  for (const auto& rotor : pair.rotors)
    for (const auto& ripple : rotor.ripples)
      force += std::abs(ripple.amplitude) / end_of(rotor, pair.rotors, pair.shaft_ends()).radius;
  return force / std::cos(pair.base_helix_angle);
}

/// N, by which the forces of the mesh are measured; 0: nothing excites the pair.
double force_scale(const HelicalPair& pair) {
  const double force = std::max(std::abs(pair.static_force()), error_force(pair));
  return force > 0 ? force : ripple_force(pair);
}

SteadyResponse pair_steady_state(const LumpedCase& lumped, const SimulationOptions& options) {
  const auto& [system, problem, turning] = lumped;
  if (options.confirmation == Confirmation::always) return steady_response(system, problem, options);
  auto quick = options;
  quick.other_motions.starts = 0;
  if (problem.period_in_cycles > long_window)
    quick.samples_per_cycle = std::min(quick.samples_per_cycle, enough_samples(problem.period_in_cycles));
  quick.min_window_cycles = std::min(options.min_window_cycles, times_period(2, problem.period_in_cycles));
  quick.confirmation = Confirmation::never;
  auto found = steady_response(system, problem, quick);
  const bool unsure = found.total_cycles == 0 && may_miss(system, *found.periodic, options.confirm_beyond);
  const bool confirmed_where_needed = options.confirmation == Confirmation::where_needed && !options.mesh_cycles;
  if (!confirmed_where_needed || (found.best.open.maxCoeff() == 0 && !unsure)) {
    look_for_other_motions(system, problem, options, found);
    return found;
  }
  auto thorough = options;
  thorough.confirmation = Confirmation::always;
  return steady_response(system, problem, thorough);
}

}  // namespace

LumpedCase lumped_case(const HelicalPair& pair) {
  auto system = assemble(pair);
  if (!(pair.pinion_speed > 0))
    throw InputError(
        fmt::format("a time response of a pair needs a speed above zero, not {} rad/s", pair.pinion_speed));
  const double scale = force_scale(pair);
  if (scale == 0)
    throw InputError(
        "a time response of a pair needs a torque or errors: torques of 0 N m and errors of 0 m excite nothing");
  return {std::move(system),
          {pair.mesh_frequency(), pair.error_period(), scale, mean_stiffness(pair.mesh)},
          turning_of(pair.shaft_ends())};
}

PairResponse evaluate_pair(const HelicalPair& pair, const SimulationOptions& options) {
  const auto lumped = lumped_case(pair);
  const auto& system = lumped.system;
  auto found = pair_steady_state(lumped, options);

  PairResponse response;
  response.mesh_frequency = pair.mesh_frequency();
  response.static_force = pair.static_force();
  const PairEvidence evidence(pair, system, found);
  response.force_max = evidence.of([](const WindowPeaks& p) { return p.force.high; }, 1);
  response.force_min = evidence.of([](const WindowPeaks& p) { return p.force.low; }, 1);
  response.force_min.value *= -1;
  response.force_mean = averaging_force(found.best).row(0).mean();
  const double f = response.static_force;
  const Figure none{not_known, not_known};
  response.peak_factor = f == 0  ? none
                         : f > 0 ? Figure{response.force_max.value / f, response.force_max.error / f}
                                 : Figure{response.force_min.value / f, -response.force_min.error / f};
  response.dynamic_factor = f == 0 ? none : branch_results(found, 0, 1, std::abs(f)).front().dynamic_factor;
  response.contact_loss = branch_results(found, 0, 1, lumped.problem.force_scale).front().contact_loss;
  response.acceleration = {evidence.acceleration(&WindowPeaks::line_of_action),
                           evidence.acceleration(&WindowPeaks::axial), evidence.acceleration(&WindowPeaks::rotation),
                           evidence.acceleration(&WindowPeaks::tooth, 2)};
  response.dynamic = {evidence.motion(&WindowPeaks::te), evidence.motion(&WindowPeaks::relative)};
  response.quasi_static = quasi_static_motions(pair, system, options);

  response.shafts = shaft_results(system, pair.rotors, pair.shaft_ends(), found);
  static_cast<SteadyOutcome&>(response) = static_cast<const SteadyOutcome&>(found);
  if (options.keep_series) response.series = series_of(system, std::move(found.best));
  return response;
}

SpaceMotion space_motion(const HelicalPair& pair, const TimeSeries& series) {
  if (!pair.space) return {};
  SpaceSystem system;
  system.bearings = bearing_coordinates(pair);
  system.faces = {&pair.space->face};
  return motion_in_space(*pair.space, system, assemble(pair), series);
}

HelicalPair with_errors_alone(HelicalPair pair) {
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  for (auto& rotor : pair.rotors) rotor.ripples.clear();
  return pair;
}

HelicalPair with_stiffness_alone(HelicalPair pair) {
  pair.mesh_error = pair.pinion.error = pair.wheel.error = {};
  for (auto& rotor : pair.rotors) rotor.ripples.clear();
  return pair;
}

TransmissionErrorShares transmission_error_shares(const HelicalPair& pair, const SimulationOptions& given) {
  auto options = given;
  options.keep_series = false;
  const auto ranges = [&](const HelicalPair& p) {
    // Neither cause nor load: nothing moves.
    if (force_scale(p) == 0) return PeakToPeak{};
    const auto r = evaluate_pair(p, options);
    return PeakToPeak{r.dynamic.transmission_error.peak_to_peak.value,
                      r.quasi_static.transmission_error.peak_to_peak.value};
  };
  const auto whole = evaluate_pair(pair, options);
  return {
      {whole.dynamic.transmission_error.peak_to_peak.value, whole.quasi_static.transmission_error.peak_to_peak.value},
      ranges(with_errors_alone(pair)),
      ranges(with_stiffness_alone(pair)),
      whole.quasi_static.transmission_error.mean.value};
}

}  // namespace annulus::dynamics
