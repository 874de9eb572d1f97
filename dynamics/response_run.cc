#include "dynamics/response_run.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "dynamics/static_solver.h"

namespace annulus::dynamics {

ResponseRun::ResponseRun(const LumpedSystem& system, double mesh_frequency, int samples_per_cycle,
                         const IntegratorOptions& integrator)
    : system_(system),
      mesh_frequency_(mesh_frequency),
      samples_per_cycle_(samples_per_cycle),
      workspace_(system.workspace()),
      integrator_(integrator) {
  require(integrator_.absolute_tolerance.has_value(), "a run needs an absolute tolerance");
  start_from_equilibrium();
}

void ResponseRun::start_from_equilibrium() {
  StaticSolver solver(system_);
  state_.v = Eigen::VectorXd::Zero(system_.freedoms());
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

void ResponseRun::advance(int cycles, ResponseWindow* window, bool track_energy) {
  const double end = (cycles_ + cycles) / mesh_frequency_;
  const int samples = window ? cycles * samples_per_cycle_ : 0;
  if (window) {
    window->samples_per_cycle = samples_per_cycle_;
    const auto meshes = static_cast<Eigen::Index>(system_.meshes().size());
    window->time.resize(samples);
    window->force.resize(meshes, samples);
    window->displacement.resize(system_.freedoms(), samples);
    window->velocity.resize(system_.freedoms(), samples);
    window->open = Eigen::VectorXd::Zero(meshes);
  }
  const auto sample = [&](int i, const SystemState& state) {
    window->time[i] = state.time;
    window->displacement.col(i) = state.q;
    window->velocity.col(i) = state.v;
    for (Eigen::Index m = 0; m < window->force.rows(); ++m) {
      window->force(m, i) = workspace_.force[m];
      if (workspace_.contact[m] == LumpedSystem::Contact::open) window->open[m] += 1.0 / samples;
    }
  };
  const auto s = integrate(system_, state_, end, integrator_, workspace_, samples, sample, track_energy);
  cycles_ += cycles;
  statistics_.steps += s.steps;
  statistics_.rhs_evaluations += s.rhs_evaluations;
  statistics_.jacobian_evaluations += s.jacobian_evaluations;
  statistics_.contact_events += s.contact_events;
  statistics_.stiffness_restarts += s.stiffness_restarts;
}

double ResponseRun::energy() {
  Eigen::VectorXd y(2 * system_.freedoms());
  y << state_.q, state_.v;
  return system_.energy(state_.time, y.data(), workspace_);
}

void ResponseRun::pass_jump() {
  const double next = system_.next_jump(state_.time);
  if (std::isfinite(next)) system_.hold_waves((state_.time + next) / 2, workspace_);
}

void ResponseRun::loosen(double factor) {
  // At most a tenth: beyond, the comparison would say little.
  integrator_.relative_tolerance = std::min(0.1, integrator_.relative_tolerance * factor);
  *integrator_.absolute_tolerance *= factor;
  integrator_.fixed_step *= std::pow(factor, 0.25);  // the error of the fixed-step method goes with step^4
}

}  // namespace annulus::dynamics
