#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

/// Tolerated error of a state entry y: relative × min(|y|, |y - origin| + extent) + absolute. With wide backlash and
/// light load, displacements are far larger than the deflections that matter.
struct StateTolerance {
  double relative = 0;
  Eigen::ArrayXd absolute, origin, extent;
};

/// Data of the SUNDIALS callbacks.
struct StepperProblem {
  const LumpedSystem& system;
  LumpedSystem::Workspace& workspace;
  /// Meshes with backlash; three root functions each: delta - half, delta + half, and while nothing touches delta'. In
  /// free flight steps are long: with its turning points, a contact that begins and ends within a step is found.
  std::vector<int> rooted;
  static constexpr std::size_t roots_per_mesh = 3;
  bool track_energy = false;
  StateTolerance tolerance{};
  IntegratorStatistics statistics{};
  const Pacing* pacing = nullptr;  ///< of integrate()
  Pacing::Now place{};             ///< of the course, at the last system_time()
  /// The time at which the system is evaluated at time t, with its rates set in the workspace.
  double system_time(double t) {
    if (!pacing) return t;
    place = pacing->at(t);
    Pacing::set_rates(place, workspace);
    return place.nominal;
  }
  [[nodiscard]] int size() const { return 2 * system.dofs() + (track_energy ? 2 : 0); }
};

/// One SUNDIALS integrator between two restarts. The state is (q, v) and, when tracked, the energies supplied and
/// dissipated.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// The state vector: set it before `restart`, read it after `advance`.
  [[nodiscard]] virtual Eigen::Map<Eigen::VectorXd> state() = 0;
  /// Begins anew at time t with the present state; no step passes `stop`.
  virtual void restart(double t, double stop) = 0;
  struct Reached {
    double time = 0;
    bool root = false;
  };
  /// Integrates to `out` (at most `stop`) or to the first root. Throws SolverError.
  virtual Reached advance(double out) = 0;
  /// +1 rising, -1 falling, 0 no root, for every root function at the last root.
  [[nodiscard]] virtual const std::vector<int>& roots() = 0;
  /// Adds the steps since the last restart to the statistics.
  virtual void close() = 0;
};

[[nodiscard]] std::unique_ptr<Stepper> make_stepper(StepperProblem& problem, const IntegratorOptions& options);

}  // namespace annulus::dynamics
