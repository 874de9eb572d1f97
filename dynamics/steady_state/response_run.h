#pragma once

#include <Eigen/Core>

#include "dynamics/steady_state/response_window.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// A system on its way: state and workspace, advanced window by window.
class ResponseRun {
 public:
  /// At time 0, in quasi-static equilibrium: this excites less than a start from rest. `mesh_frequency` (Hz) tells what
  /// a cycle is.
  ResponseRun(const LumpedSystem& system, double mesh_frequency, int samples_per_cycle,
              const IntegratorOptions& integrator);

  /// Begins at time 0 with this state instead.
  void start_from(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);
  /// Integrates over whole mesh cycles; `window` (may be null) receives the samples.
  void advance(int cycles, ResponseWindow* window, bool track_energy = false);
  /// Energy at the end of what has been integrated, a stiffness jump at this very instant not yet done.
  [[nodiscard]] const LumpedSystem& system() const { return system_; }
  [[nodiscard]] double energy();
  /// Does a stiffness jump at this very instant: whole mesh cycles are where waves jump.
  void pass_jump();
  void loosen(double factor);

  [[nodiscard]] const SystemState& state() const { return state_; }
  [[nodiscard]] const IntegratorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] int cycles() const { return cycles_; }

 private:
  void start_from_equilibrium();

  const LumpedSystem& system_;
  double mesh_frequency_ = 0;
  int samples_per_cycle_ = 0;
  LumpedSystem::Workspace workspace_;
  IntegratorOptions integrator_;
  SystemState state_;
  IntegratorStatistics statistics_;
  int cycles_ = 0;
};

}  // namespace annulus::dynamics
