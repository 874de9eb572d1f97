#include "dynamics/time_integration/integrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "core/errors.h"
#include "dynamics/time_integration/integrator_choice.h"
#include "dynamics/time_integration/stepper.h"

namespace annulus::dynamics {

namespace {

using Contact = LumpedSystem::Contact;

void check_options(const IntegratorOptions& options) {
  if (!(options.relative_tolerance > 0 && options.relative_tolerance < 1))
    throw InputError(fmt::format("relative tolerance {} must lie between 0 and 1", options.relative_tolerance));
  if (options.absolute_tolerance && !(*options.absolute_tolerance > 0))
    throw InputError(fmt::format("absolute tolerance {} m must be positive", *options.absolute_tolerance));
  if (options.method == Integrator::runge_kutta_4 && !(options.fixed_step > 0))
    throw InputError(
        fmt::format("the fixed-step Runge-Kutta method needs a positive step, not {} s", options.fixed_step));
  if (options.method != Integrator::runge_kutta_4 && options.fixed_step != 0)
    throw InputError(
        fmt::format("a fixed step ({} s) belongs to the Runge-Kutta method; other integrators choose their steps",
                    options.fixed_step));
}

/// Tolerances of (q, v, energies). Velocities count like a displacement at mesh frequency (or at the highest local
/// frequency when nothing meshes); the energies follow the state and do not steer the step.
StateTolerance state_tolerance(const LumpedSystem& system, const IntegratorOptions& options,
                               const LumpedSystem::Workspace& workspace, const Eigen::VectorXd& start, int size) {
  double displacement = options.absolute_tolerance.value_or(0.0);
  if (!options.absolute_tolerance) {
    for (const double delta : workspace.delta) displacement = std::max(displacement, std::abs(delta));
    displacement *= 0.1 * options.relative_tolerance;
    if (!(displacement > 0))
      throw InputError(fmt::format(
          "none of the {} meshes is deflected at the start, so no absolute tolerance can be derived: give one",
          workspace.delta.size()));
  }
  const int n = system.dofs();
  double frequency = 0;
  Eigen::ArrayXd rate(n);
  for (const auto& mesh : system.meshes())
    frequency = std::max(frequency, 2 * std::numbers::pi * std::abs(mesh.frequency));
  for (int i = 0; i < n; ++i) {
    double stiffness = system.stiffness()(i, i);
    for (std::size_t m = 0; m < system.meshes().size(); ++m)
      stiffness += workspace.stiffness[m] * std::pow(system.mesh_vector(static_cast<int>(m))[i], 2);
    rate[i] = std::sqrt(stiffness / system.mass()(i, i));
  }
  if (frequency == 0) frequency = rate.maxCoeff() > 0 ? rate.maxCoeff() : 1.0;
  // Implicit steps may be far longer than vibrations. A velocity then counts like the displacement it becomes in the
  // vibration of its DOF. Measured by the mesh frequency, it would make the method resolve rounding.
  const bool implicit = options.method == Integrator::arkode_implicit;
  StateTolerance tolerance;
  tolerance.relative = options.relative_tolerance;
  tolerance.absolute = Eigen::ArrayXd::Constant(size, 1e99);
  tolerance.absolute.head(n).setConstant(displacement);
  tolerance.absolute.segment(n, n).setConstant(displacement * frequency);
  if (implicit) tolerance.absolute.segment(n, n) = displacement * rate.max(frequency);
  tolerance.origin = Eigen::ArrayXd::Zero(size);
  tolerance.origin.head(n) = start;
  tolerance.extent = tolerance.absolute * (10 / options.relative_tolerance);
  return tolerance;
}

/// Sets the contact states after the roots just found. Has any changed?
bool apply_roots(const StepperProblem& problem, const std::vector<int>& roots) {
  bool changed = false;
  for (std::size_t i = 0; i < problem.rooted.size(); ++i) {
    auto& contact = problem.workspace.contact[problem.rooted[i]];
    const int* of_mesh = &roots[StepperProblem::roots_per_mesh * i];
    if (of_mesh[0] != 0) contact = of_mesh[0] > 0 ? Contact::drive : Contact::open;
    if (of_mesh[1] != 0) contact = of_mesh[1] > 0 ? Contact::open : Contact::back;
    changed = changed || of_mesh[0] != 0 || of_mesh[1] != 0;
  }
  return changed;
}

/// Does a deflection contradict a held contact state by more than the accuracy of a located root? (Two roots closer
/// than rounding after a restart may hide each other.)
bool contact_contradicted(const StepperProblem& problem) {
  for (const int m : problem.rooted) {
    const double half = *problem.system.meshes()[m].half_backlash, delta = problem.workspace.delta[m];
    const double slack = 1e-4 * std::min(half, problem.tolerance.extent[0]) + 1e-14 * half;
    const auto contact = problem.workspace.contact[m];
    if (contact == Contact::drive  ? delta < half - slack
        : contact == Contact::back ? delta > -half + slack
                                   : std::abs(delta) > half + slack)
      return true;
  }
  return false;
}

/// Does an open mesh turn at this very instant? SUNDIALS steps off a root by rounding, over which this one stays zero,
/// and refuses two roots so close together; a restart leaves it out until it differs from zero.
bool turns_exactly(const StepperProblem& problem) {
  return std::any_of(problem.rooted.begin(), problem.rooted.end(), [&](int m) {
    return problem.workspace.contact[m] == Contact::open && problem.workspace.delta_rate[m] == 0;
  });
}

/// Elastic energy of meshes whose stiffness jumps at `t`, after minus before: held waves before, `middle` after.
double jump_energy(const LumpedSystem& system, double t, double middle, const double* y,
                   LumpedSystem::Workspace& workspace, const std::function<void(double)>& at_jump) {
  const double before = system.energy(t, y, workspace);  // evaluates the mesh forces too
  if (at_jump) at_jump(t);
  system.hold_waves(middle, workspace);
  const double after = system.energy(t, y, workspace);
  if (at_jump) at_jump(t);
  return after - before;
}

/// One integration from event to event: roots of the contact, jumps of stiffnesses, samples.
class Integration {
 public:
  Integration(const LumpedSystem& system, SystemState& state, double end, LumpedSystem::Workspace& workspace,
              const IntegrationObserver& observer)
      : system_(system),
        state_(state),
        workspace_(workspace),
        observer_(observer),
        problem_{system, workspace, {}, observer.energy == EnergyTracking::on},
        start_(state.time),
        end_(end),
        time_(state.time),
        instant_(1e-14 * std::max({std::abs(start_), std::abs(end), end - start_})) {
    for (std::size_t m = 0; m < system.meshes().size(); ++m)
      if (system.meshes()[m].half_backlash.value_or(0.0) > 0) problem_.rooted.push_back(static_cast<int>(m));
  }

  IntegratorStatistics run(const IntegratorOptions& options, const Pacing* pacing) {
    problem_.pacing = pacing;
    begin(options);
    emit_samples();
    stepper_->restart(time_, stop_);
    while (time_ < end_) {
      advance();
      if (time_ >= stop_ && time_ < end_) pass_jump();
      emit_samples();
    }
    finish();
    return problem_.statistics;
  }

 private:
  void begin(const IntegratorOptions& options) {
    const int n = system_.dofs();
    stop_ = segment_end();
    system_.hold_waves(problem_.system_time((time_ + stop_) / 2), workspace_);
    system_.detect_contact(problem_.system_time(time_), state_.q.data(), workspace_);
    problem_.tolerance = state_tolerance(system_, options, workspace_, state_.q, problem_.size());
    stepper_ = make_stepper(problem_, options);
    auto y = stepper_->state();
    y.head(n) = state_.q;
    y.segment(n, n) = state_.v;
    if (problem_.track_energy) y.tail(2) << state_.supplied, state_.dissipated;
    stretch_ = end_ - start_;
    constexpr double cycles_per_stretch = 1e4;
    for (const auto& mesh : system_.meshes())
      if (mesh.frequency != 0) stretch_ = std::min(stretch_, cycles_per_stretch / std::abs(mesh.frequency));
  }

  /// Up to the next sample, jump or contact event.
  void advance() {
    // The limit of steps is one per stretch, so that it stops a run without end but not a long one.
    const double target = std::min(
        next_sample_ < observer_.samples ? std::min(sample_time(next_sample_), stop_) : stop_, time_ + stretch_);
    const auto reached = stepper_->advance(target);
    time_ = stop_ - reached.time < instant_ ? stop_ : reached.time;
    const auto y = stepper_->state();
    if (!y.allFinite()) {
      Eigen::Index first = 0;
      while (std::isfinite(y[first])) ++first;
      throw SolverError(
          fmt::format("the time integration reached {} for {} at t = {:.9g} s", y[first], name_of(first), time_));
    }
    if (reached.root && apply_roots(problem_, stepper_->roots())) {
      restart_at_contact();
    } else if (!problem_.rooted.empty()) {
      evaluate_meshes();
      if (!contact_contradicted(problem_)) {
        if (reached.root && turns_exactly(problem_) && time_ < stop_) stepper_->restart(time_, stop_);
        return;
      }
      system_.detect_contact(problem_.system_time(time_), y.data(), workspace_);
      restart_at_contact();
    }
  }

  void restart_at_contact() {
    ++problem_.statistics.contact_events;
    if (time_ < stop_) stepper_->restart(time_, stop_);
  }

  void pass_jump() {
    stop_ = segment_end();
    auto y = stepper_->state();
    const double middle = problem_.system_time((time_ + stop_) / 2), now = problem_.system_time(time_);
    const double change = jump_energy(system_, now, middle, y.data(), workspace_, observer_.at_jump);
    if (problem_.track_energy) y[2 * system_.dofs()] += change;
    ++problem_.statistics.stiffness_restarts;
    stepper_->restart(time_, stop_);
  }

  void emit_samples() {
    for (; next_sample_ < observer_.samples && sample_time(next_sample_) <= time_ + instant_; ++next_sample_) {
      evaluate_meshes();
      store();
      if (observer_.sample) observer_.sample(next_sample_, state_);
    }
  }

  void finish() {
    stepper_->close();
    if (observer_.at_jump && std::isfinite(system_.next_jump(end_))) {
      evaluate_meshes();
      observer_.at_jump(end_);
    }
    store();
  }

  void store() {
    const int n = system_.dofs();
    const auto y = stepper_->state();
    state_.time = time_;
    state_.q = y.head(n);
    state_.v = y.segment(n, n);
    if (!problem_.track_energy) return;
    state_.supplied = y[2 * n];
    state_.dissipated = y[2 * n + 1];
  }

  void evaluate_meshes() {
    const auto y = stepper_->state();
    system_.evaluate_meshes(problem_.system_time(time_), y.data(), y.data() + system_.dofs(), workspace_);
  }

  [[nodiscard]] double segment_end() const {
    const double next = problem_.pacing ? problem_.pacing->next_stop(time_) : system_.next_jump(time_);
    return end_ - next < instant_ ? end_ : next;
  }
  [[nodiscard]] double sample_time(int i) const {
    return observer_.time_of ? observer_.time_of(i) : start_ + i * (end_ - start_) / observer_.samples;
  }
  [[nodiscard]] std::string name_of(Eigen::Index entry) const {
    const int n = system_.dofs();
    if (entry < n) return system_.names()[static_cast<std::size_t>(entry)];
    return entry < 2 * n ? "the velocity of " + system_.names()[static_cast<std::size_t>(entry - n)] : "an energy";
  }

  const LumpedSystem& system_;
  SystemState& state_;
  LumpedSystem::Workspace& workspace_;
  const IntegrationObserver& observer_;
  StepperProblem problem_;
  std::unique_ptr<Stepper> stepper_;
  double start_ = 0, end_ = 0, time_ = 0;
  double instant_ = 0;  ///< s, times closer than this are one: SUNDIALS refuses to integrate over a rounding error
  double stop_ = 0;     ///< s, next jump of a stiffness or point of the course, or the end
  double stretch_ = 0;  ///< s, longest distance of one call of the stepper
  int next_sample_ = 0;
};

}  // namespace

IntegratorStatistics integrate(const LumpedSystem& system, SystemState& state, double end,
                               const IntegratorOptions& given, LumpedSystem::Workspace& workspace,
                               const IntegrationObserver& observer, const Pacing* pacing) {
  check_options(given);
  IntegratorOptions options = given;
  if (options.method == Integrator::automatic)
    options.method = choose_integrator(system, options.relative_tolerance).method;
  if (pacing && observer.energy == EnergyTracking::on)
    throw InputError("energies are not tracked while a system follows a course of speed and torque");
  require(state.q.size() == system.dofs() && state.v.size() == system.dofs(),
          fmt::format("a state of {} displacements and {} velocities for {} degrees of freedom", state.q.size(),
                      state.v.size(), system.dofs()));
  if (!(end > state.time))
    throw InputError(fmt::format("an integration from {:.9g} s must end later than at {:.9g} s", state.time, end));
  return Integration(system, state, end, workspace, observer).run(options, pacing);
}

}  // namespace annulus::dynamics
