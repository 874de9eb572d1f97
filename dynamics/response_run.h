#pragma once

#include <Eigen/Core>

#include "dynamics/response.h"

namespace annulus::dynamics {

/// Samples of one window: meshes (and freedoms) x times.
struct ResponseWindow {
  int samples_per_cycle = 0;
  Eigen::VectorXd time;
  Eigen::MatrixXd force, displacement, velocity;
  Eigen::VectorXd open;  ///< fraction of the samples without contact, per mesh
};

/// The stage on its way: state and workspace, advanced window by window.
class ResponseRun {
 public:
  /// At time 0, in quasi-static equilibrium: this excites less than a start from rest.
  ResponseRun(const PlanetaryStage& stage, const LumpedSystem& system, const SimulationOptions& options,
              const IntegratorOptions& integrator);

  /// Begins at time 0 with this state instead.
  void start_from(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);
  /// Integrates over whole mesh cycles; `window` (may be null) receives the samples.
  void advance(int cycles, ResponseWindow* window, bool track_energy = false);
  /// Energy at the end of what has been integrated, a stiffness jump at this very instant not yet done.
  [[nodiscard]] double energy();
  /// Does a stiffness jump at this very instant: whole mesh cycles are where waves jump.
  void pass_jump();
  void loosen(double factor);

  [[nodiscard]] const SystemState& state() const { return state_; }
  [[nodiscard]] const IntegratorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] int cycles() const { return cycles_; }

 private:
  void start_from_equilibrium();

  const PlanetaryStage& stage_;
  const LumpedSystem& system_;
  int samples_per_cycle_ = 0;
  LumpedSystem::Workspace workspace_;
  IntegratorOptions integrator_;
  SystemState state_;
  IntegratorStatistics statistics_;
  int cycles_ = 0;
};

}  // namespace annulus::dynamics
