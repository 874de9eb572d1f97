#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/model/lumped_model.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "core/csv.h"
#include "core/figure.h"
#include "dynamics/error_propagation/error_propagation.h"
#include "dynamics/systems/two_k_v/two_k_v_response.h"

namespace annulus::app {

/// The periodic motion of a 2K-V stage. Angles in rad, forces in N.
struct TwoKVMotion {
  double crank_frequency = 0, sun_mesh_frequency = 0, arc_mesh_frequency = 0;  ///< Hz, in the frame of the carrier
  double mean_sun_force = 0, mean_arc_force = 0;
  int crank_turns = 0, total_cycles = 0;
  bool steady = false;
  std::optional<double> steady_difference, torque_balance_relative, largest_multiplier;
  double energy_relative = 0;
  dynamics::FoundMotions motions;
  Figure error_peak_to_peak;  ///< of the output against the input
  double error_mean = 0, static_error_mean = 0, static_error_peak_to_peak = 0;
  std::vector<dynamics::BranchResult> sun_planet, arc_pins;
  std::vector<dynamics::ArcBearingResult> arc_bearings;
  std::vector<dynamics::ShaftResult> shafts;

  FigureSet results;  ///< by key, with the parts of their errors; of the lumped model and of every mesh

  Csv output_error;         ///< crank_turn, time_s, error_rad
  Csv static_error;         ///< crank_turn, error_rad: K(t) q = f
  Csv spectrum;             ///< frequency_Hz, crank_order, amplitude_rad; empty where the window holds no whole turns
  Csv forces;               ///< crank_turn, F / mean mesh force of every mesh
  std::string time_series;  ///< the file of all motions and forces; empty once it is written
  bool reused = false;

  /// Whether the output moves against the input beyond rounding. Constant mesh stiffness moves nothing: the whole load
  /// winds the train up evenly, whatever the crank angle.
  [[nodiscard]] bool output_moves() const;
};

/// Its results, those of every mesh by itself besides: sun_planet1_dynamic_factor, arc_pins2_dynamic_factor, ...
[[nodiscard]] dynamics::Evaluation evaluation_of(const TwoKVModels& models, const dynamics::TwoKVResponse& response);

/// The ways of the cost study to the motion on these stiffnesses.
[[nodiscard]] ModelWays two_k_v_ways(const Scene& scene, const TwoKVTables& tables);

/// Simulates the stage of a scene and propagates the errors of its tables into the results.
[[nodiscard]] TwoKVMotion simulate_two_k_v(const Scene& scene, const TwoKVTables& tables,
                                           const dynamics::SimulationOptions& options);
/// Writes figures.json, output_error.csv, output_error_static.csv, spectrum.csv, forces.csv and time_series.csv into
/// `folder`.
void save(const TwoKVMotion& motion, const std::string& id, const std::filesystem::path& folder);

}  // namespace annulus::app
