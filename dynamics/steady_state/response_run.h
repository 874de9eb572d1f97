#pragma once

#include <Eigen/Core>

#include "dynamics/steady_state/response_window.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// A time integration that advances window by window: the system, its state and its workspace.
class ResponseRun {
 public:
  /// Starts at time 0 in quasi-static equilibrium, which excites less vibration than a start from rest.
  /// `mesh_frequency` (Hz) defines a mesh cycle. The integrator needs an absolute tolerance.
  ResponseRun(const LumpedSystem& system, double mesh_frequency, int samples_per_cycle,
              const IntegratorOptions& integrator);

  /// Starts at time 0 with this state instead: displacement (m) and velocity (m/s), one entry per DOF.
  void start_from(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);
  /// Windows also have forces at `times` as many instants, for their peaks. For systems without jumps.
  void sample_forces_closer(int times) { closer_ = times; }
  /// Integrates over whole mesh cycles; `window` (may be null) receives the samples.
  void advance(int cycles, ResponseWindow* window, EnergyTracking energy = EnergyTracking::off);
  [[nodiscard]] const LumpedSystem& system() const { return system_; }
  /// Energy (J) of the present state, before a stiffness jump at this very instant.
  [[nodiscard]] double energy();
  /// Applies a stiffness jump at this very instant: rectangular stiffnesses jump at whole mesh cycles.
  void pass_jump();
  /// Multiplies the tolerances by `factor`; the relative one becomes 0.1 at most. Fixed steps become half as long
  /// instead: longer ones may be unstable, and halves show 15/16 of the error.
  void change_accuracy(double factor);

  [[nodiscard]] const SystemState& state() const { return state_; }
  [[nodiscard]] const IntegratorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] int cycles() const { return cycles_; }

 private:
  void start_from_equilibrium();

  const LumpedSystem& system_;
  double mesh_frequency_ = 0;
  int samples_per_cycle_ = 0, closer_ = 1;
  LumpedSystem::Workspace workspace_;
  IntegratorOptions integrator_;
  SystemState state_;
  IntegratorStatistics statistics_;
  int cycles_ = 0;
};

}  // namespace annulus::dynamics
