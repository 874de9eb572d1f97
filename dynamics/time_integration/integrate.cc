#include "dynamics/time_integration/integrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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
    throw InputError("the absolute tolerance must be positive");
  if (options.method == Integrator::runge_kutta_4 && !(options.fixed_step > 0))
    throw InputError("the fixed-step Runge-Kutta method needs a positive fixed step");
  if (options.method != Integrator::runge_kutta_4 && options.fixed_step != 0)
    throw InputError("a fixed step goes with the Runge-Kutta method only; the others choose their steps");
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
      throw InputError("the start deflects no mesh: give an absolute tolerance, none can be derived");
  }
  const int n = system.dofs();
  double frequency = 0;
  Eigen::ArrayXd rate(n);
  for (const auto& mesh : system.meshes()) frequency = std::max(frequency, 2 * std::numbers::pi * mesh.frequency);
  for (int i = 0; i < n; ++i) {
    double stiffness = system.stiffness()(i, i);
    for (std::size_t m = 0; m < system.meshes().size(); ++m)
      stiffness += workspace.stiffness[m] * std::pow(system.mesh_vector(static_cast<int>(m))[i], 2);
    rate[i] = std::sqrt(stiffness / system.mass()(i, i));
  }
  if (frequency == 0) frequency = rate.maxCoeff() > 0 ? rate.maxCoeff() : 1.0;
  // Steps may be far longer than vibrations: a velocity counts like the displacement it becomes in the vibration of its
  // DOF. Held to the pace of the meshes, the implicit method would resolve rounding.
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

/// The contact states after the roots just found.
void apply_roots(const StepperProblem& problem, const std::vector<int>& roots) {
  for (std::size_t i = 0; i < problem.rooted.size(); ++i) {
    auto& contact = problem.workspace.contact[problem.rooted[i]];
    if (roots[2 * i] != 0) contact = roots[2 * i] > 0 ? Contact::drive : Contact::open;
    if (roots[2 * i + 1] != 0) contact = roots[2 * i + 1] > 0 ? Contact::open : Contact::back;
  }
}

/// Is a held contact state contradicted by more than the accuracy of a located root? (Two roots closer than rounding
/// after a restart may hide each other.)
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

}  // namespace

IntegratorStatistics integrate(const LumpedSystem& system, SystemState& state, double end,
                               const IntegratorOptions& given, LumpedSystem::Workspace& workspace, int samples,
                               const std::function<void(int, const SystemState&)>& sample, bool track_energy,
                               const std::function<void(double)>& at_jump) {
  check_options(given);
  IntegratorOptions options = given;
  if (options.method == Integrator::automatic)
    options.method = choose_integrator(system, options.relative_tolerance).method;
  const int n = system.dofs();
  require(state.q.size() == n && state.v.size() == n, "state and system differ in size");
  if (!(end > state.time)) throw InputError("an integration must end after its start");
  StepperProblem problem{system, workspace, {}, track_energy};
  for (std::size_t m = 0; m < system.meshes().size(); ++m)
    if (system.meshes()[m].half_backlash.value_or(0.0) > 0) problem.rooted.push_back(static_cast<int>(m));

  const double start = state.time;
  double t = start;
  // Times closer than this are one: SUNDIALS refuses to integrate over a distance of rounding.
  const double instant = 1e-14 * std::max({std::abs(start), std::abs(end), end - start});
  const auto segment_end = [&] {
    const double jump = system.next_jump(t);
    return end - jump < instant ? end : jump;
  };
  double stop = segment_end();
  system.hold_waves((t + stop) / 2, workspace);
  system.detect_contact(t, state.q.data(), workspace);
  problem.tolerance = state_tolerance(system, options, workspace, state.q, problem.size());
  const auto stepper = make_stepper(problem, options);
  auto y = stepper->state();
  y.head(n) = state.q;
  y.segment(n, n) = state.v;
  if (track_energy) y.tail(2) << state.supplied, state.dissipated;

  const auto store = [&] {
    state.time = t;
    state.q = y.head(n);
    state.v = y.segment(n, n);
    if (track_energy) {
      state.supplied = y[2 * n];
      state.dissipated = y[2 * n + 1];
    }
  };
  double stretch = end - start;
  constexpr double cycles_per_stretch = 1e4;
  for (const auto& mesh : system.meshes())
    if (mesh.frequency > 0) stretch = std::min(stretch, cycles_per_stretch / mesh.frequency);
  int next = 0;
  const auto sample_time = [&](int i) { return start + i * (end - start) / samples; };
  const auto emit = [&] {
    for (; next < samples && sample_time(next) <= t + instant; ++next) {
      system.evaluate_meshes(t, y.data(), y.data() + n, workspace);
      store();
      if (sample) sample(next, state);
    }
  };

  emit();
  stepper->restart(t, stop);
  while (t < end) {
    // The limit of steps is one per stretch, so that it stops a hopeless run but not a long one.
    const double target = std::min(next < samples ? std::min(sample_time(next), stop) : stop, t + stretch);
    const auto reached = stepper->advance(target);
    t = stop - reached.time < instant ? stop : reached.time;
    if (!y.allFinite()) throw SolverError(fmt::format("the time integration left the numbers at t = {:.9g} s", t));
    if (reached.root) {
      apply_roots(problem, stepper->roots());
      ++problem.statistics.contact_events;
      if (t < stop) stepper->restart(t, stop);
    } else if (!problem.rooted.empty()) {
      system.evaluate_meshes(t, y.data(), y.data() + n, workspace);
      if (contact_contradicted(problem)) {
        system.detect_contact(t, y.data(), workspace);
        ++problem.statistics.contact_events;
        if (t < stop) stepper->restart(t, stop);
      }
    }
    if (t >= stop && t < end) {
      stop = segment_end();
      const double change = jump_energy(system, t, (t + stop) / 2, y.data(), workspace, at_jump);
      if (track_energy) y[2 * n] += change;
      ++problem.statistics.stiffness_restarts;
      stepper->restart(t, stop);
    }
    emit();
  }
  stepper->close();
  if (at_jump && std::isfinite(system.next_jump(end))) {
    system.evaluate_meshes(end, y.data(), y.data() + n, workspace);
    at_jump(end);
  }
  store();
  return problem.statistics;
}

}  // namespace annulus::dynamics
