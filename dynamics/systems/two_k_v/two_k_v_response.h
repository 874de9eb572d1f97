#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/figures/mesh_results.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/figures/spectrum.h"
#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

/// theta_o - theta_i/ratio, rad: lead of the output.
struct OutputError {
  Eigen::VectorXd series;  ///< over the window
  double mean = 0;         ///< the wind-up under the torque
  Figure peak_to_peak;
};

/// One bearing of an arc gear on an eccentric, both directions together.
struct ArcBearingResult {
  int crank = 0, arc_gear = 0;  ///< from 0
  Figure largest;               ///< N, of the resultant
  double mean = 0;              ///< N
};

struct TwoKVResponse : SteadyOutcome {
  double crank_frequency = 0, sun_mesh_frequency = 0, arc_mesh_frequency = 0;  ///< Hz, in the frame of the carrier
  double mean_sun_force = 0, mean_arc_force = 0;                               ///< N, reference of the factors
  int crank_turns = 0;                                                         ///< in the window
  OutputError dynamic;
  OutputError
      quasi_static;  ///< K(t) q = f at `quasi_static_time`: the error of the changing stiffness alone, without rotors
  Eigen::VectorXd quasi_static_time;  ///< s, over one period
  std::vector<BranchResult> sun_planet, arc_pins;
  std::vector<ArcBearingResult> arc_bearings;
  Spectrum error_spectrum;  ///< of the dynamic error, rad; orders count turns of the crank. Empty where the window
                            ///< holds no whole turns
  /// Relative difference between T/ratio and the mean torque of the sun meshes, with the change of the momentum of sun
  /// and input. Absent where the input has a support.
  std::optional<double> torque_balance_relative;
  /// Largest modulus of a Floquet multiplier of one period, without the double unit one of a rigid motion. Below 1 the
  /// motion is stable, above 1 the changing stiffness feeds it. Absent without shooting.
  std::optional<double> largest_multiplier;
  std::vector<ShaftResult> shafts;
  TimeSeries series;  ///< empty without `keep_series`
};

/// Turns of the crank against the carrier after which everything repeats: one, unless a table spans several cycles or
/// torques of rotors have other periods. One
/// turn moves every sun mesh on by z_p whole cycles and every arc mesh by z_a, and restores the bearing directions.
[[nodiscard]] int period_in_crank_turns(const TwoKVStage& stage);

/// The system that is solved, with its cycles those of the sun meshes. Throws InputError without speed or torque.
[[nodiscard]] LumpedCase lumped_case(const TwoKVStage& stage);

/// Periodic steady state at output_speed under output_torque (both > 0), with mesh stiffnesses and bearing directions
/// that change in time.
///
/// It is found by shooting and confirmed by time integration until windows repeat. Time integration alone would take
/// hundreds of crank turns, because dampers of stiff bearings damp the first mode little. With `mesh_cycles` it runs
/// from quasi-static equilibrium alone. Cycles of the options are those of the sun meshes.
///
/// Throws InputError without speed or torque, when both ends are held, or when the load is not balanced.
[[nodiscard]] TwoKVResponse simulate(const TwoKVStage& stage, const SimulationOptions& options = {});

}  // namespace annulus::dynamics
