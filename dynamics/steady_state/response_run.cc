#include "dynamics/steady_state/response_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"

namespace annulus::dynamics {

namespace {

/// Every jump has the forces before and after it. At the end of the window only those before: its beginning follows.
void set_jumps(ResponseWindow& window, const std::vector<double>& times, const std::vector<double>& forces) {
  const Eigen::Index meshes = window.force.rows(), notes = static_cast<Eigen::Index>(times.size());
  const Eigen::Map<const Eigen::MatrixXd> noted(forces.data(), meshes, notes);
  const Eigen::Index jumps = (notes + 1) / 2;
  window.jump_time.resize(jumps);
  window.force_before.resize(meshes, jumps);
  window.force_after.resize(meshes, jumps);
  if (jumps == 0) return;
  require(notes % 2 == 1, fmt::format("{} forces at jumps: two per jump and one at the end of a window", notes));
  window.jump_time[0] = window.time[0];
  window.force_before.col(0) = noted.col(notes - 1);
  window.force_after.col(0) = window.force.col(0);
  for (Eigen::Index j = 1; j < jumps; ++j) {
    window.jump_time[j] = times[static_cast<std::size_t>(2 * j - 2)];
    window.force_before.col(j) = noted.col(2 * j - 2);
    window.force_after.col(j) = noted.col(2 * j - 1);
  }
}

}  // namespace

ResponseRun::ResponseRun(const LumpedSystem& system, double mesh_frequency, int samples_per_cycle,
                         const IntegratorOptions& integrator)
    : system_(system),
      mesh_frequency_(mesh_frequency),
      samples_per_cycle_(samples_per_cycle),
      workspace_(system.workspace()),
      integrator_(integrator) {
  require(integrator_.absolute_tolerance.has_value(),
          fmt::format("a run at {:g} Hz needs an absolute tolerance", mesh_frequency));
  start_from_equilibrium();
}

void ResponseRun::start_from_equilibrium() {
  StaticSolver solver(system_);
  state_.v = Eigen::VectorXd::Zero(system_.dofs());
  if (!std::isfinite(system_.next_jump(0))) {
    const double h = 1e-3 / mesh_frequency_;  // a thousandth of a cycle: smooth there, far above rounding
    const Eigen::VectorXd after = solver.solve(h, workspace_), before = solver.solve(-h, workspace_);
    state_.v = (after - before) / (2 * h);
  }
  state_.q = solver.solve(0, workspace_);
}

void ResponseRun::start_from(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) {
  state_ = {};
  state_.q = displacement;
  state_.v = velocity;
  system_.detect_contact(0, state_.q.data(), workspace_);
}

void ResponseRun::advance(int cycles, ResponseWindow* window, EnergyTracking energy) {
  const double end = (cycles_ + cycles) / mesh_frequency_;
  const int samples = window ? cycles * samples_per_cycle_ : 0, instants = samples * closer_;
  if (window) {
    window->samples_per_cycle = samples_per_cycle_;
    const auto meshes = static_cast<Eigen::Index>(system_.meshes().size());
    window->time.resize(samples);
    window->force.resize(meshes, samples);
    window->displacement.resize(system_.dofs(), samples);
    window->velocity.resize(system_.dofs(), samples);
    window->open = window->back = Eigen::VectorXd::Zero(meshes);
    window->dense_force.resize(closer_ > 1 ? meshes : 0, closer_ > 1 ? instants : 0);
    window->dense_per_sample = closer_;
  }
  IntegrationObserver observer{.samples = instants, .sample = {}, .at_jump = {}, .energy = energy};
  observer.sample = [&](int instant, const SystemState& state) {
    const Eigen::Map<const Eigen::VectorXd> force(workspace_.force.data(), window->force.rows());
    for (Eigen::Index m = 0; m < window->force.rows(); ++m) {
      if (workspace_.contact[m] == LumpedSystem::Contact::open) window->open[m] += 1.0 / instants;
      if (workspace_.elastic[m] < 0) window->back[m] += 1.0 / instants;
    }
    if (closer_ > 1) window->dense_force.col(instant) = force;
    if (instant % closer_ != 0) return;
    const int i = instant / closer_;
    window->time[i] = state.time;
    window->displacement.col(i) = state.q;
    window->velocity.col(i) = state.v;
    window->force.col(i) = force;
  };
  std::vector<double> jump_time, jump_force;
  const double start = state_.time, spacing = (end - start) / std::max(samples, 1);
  if (window) {
    window->after_jump.clear();
    window->dense_after_jump.clear();
    observer.at_jump = [&](double time) {
      jump_time.push_back(time);
      jump_force.insert(jump_force.end(), workspace_.force.begin(), workspace_.force.end());
      const auto note = [&](std::vector<Eigen::Index>& list, int instants_of_sample) {
        // Rounding of a sample that stands on the jump itself: far below a billionth of the spacing.
        const auto after = static_cast<Eigen::Index>(std::ceil((time - start) / spacing * instants_of_sample - 1e-9));
        if (after < static_cast<Eigen::Index>(samples) * instants_of_sample && (list.empty() || list.back() != after))
          list.push_back(after);
      };
      note(window->after_jump, 1);
      if (closer_ > 1) note(window->dense_after_jump, closer_);
    };
  }
  const auto s = integrate(system_, state_, end, integrator_, workspace_, observer);
  if (window) set_jumps(*window, jump_time, jump_force);
  cycles_ += cycles;
  statistics_.steps += s.steps;
  statistics_.rhs_evaluations += s.rhs_evaluations;
  statistics_.jacobian_evaluations += s.jacobian_evaluations;
  statistics_.contact_events += s.contact_events;
  statistics_.stiffness_restarts += s.stiffness_restarts;
}

double ResponseRun::energy() {
  Eigen::VectorXd y(2 * system_.dofs());
  y << state_.q, state_.v;
  return system_.energy(state_.time, y.data(), workspace_);
}

void ResponseRun::pass_jump() {
  const double next = system_.next_jump(state_.time);
  if (std::isfinite(next)) system_.hold_waves((state_.time + next) / 2, workspace_);
}

void ResponseRun::change_accuracy(double factor) {
  // At most a tenth: with a looser tolerance the comparison would mean little.
  integrator_.relative_tolerance = std::min(0.1, integrator_.relative_tolerance * factor);
  *integrator_.absolute_tolerance *= factor;
  integrator_.fixed_step /= 2;
}

}  // namespace annulus::dynamics
