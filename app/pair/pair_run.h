#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/pair/pair_errors.h"
#include "app/pair/pair_stiffness.h"
#include "app/plan/plan.h"
#include "app/study/study_result.h"
#include "core/csv.h"
#include "dynamics/modes/modes.h"
#include "dynamics/systems/helical_pair/pair_response.h"

/// Scenes of kind helical_pair from the scene to the report:
///
///     Scene ─► PairGeometry ─► PairMesh (formula, closed form, finite elements) ─┐
///          └─► PairErrors (random composite deviations) ─────────────────────────┴─► PairResponse ─► studies ─► report
namespace annulus::app {

/// What part of the transmission error is manufacturing error, at one torque of the pinion.
struct ShareRow {
  double pinion_torque = 0;  ///< N m
  dynamics::TransmissionErrorShares shares{};
  double largest_dynamic = 0, largest_static = 0;  ///< m, largest magnitude of u_1 + u_2, the mean included
  std::string failure{};                           ///< empty: none
};

/// What each cause alone does at one speed of the pinion.
struct SpeedRow {
  struct Motion {
    double acceleration = 0;  ///< m/s^2, of the teeth
    double force_range = 0;   ///< N, largest - smallest mesh force
    double te_range = 0;      ///< m, peak-to-peak u_1 + u_2
  };
  double pinion_speed = 0;                          ///< rad/s
  Motion all{}, errors_alone{}, stiffness_alone{};  ///< errors alone: at constant mean stiffness
  std::string failure{};
};

/// Largest and smallest mesh force in the direction of the load (that of the driving flanks without a torque), N.
struct LoadedForce {
  Figure largest, smallest;
};
[[nodiscard]] LoadedForce loaded_force(const dynamics::PairResponse& response);

struct PairResponseResult {
  dynamics::PairResponse figures;  ///< without the series
  dynamics::Modes modes;
  Csv series;    ///< one row per sample: time, DOFs, force, transmission error
  Csv spectrum;  ///< of the mesh force
};

struct PairRunResult {
  Scene scene;
  PairGeometry geometry;
  Plan plan;
  PairMesh mesh{};
  std::vector<MeanStiffness> stiffnesses{};
  PairErrors errors{};
  std::optional<dynamics::HelicalPair> pair{};  ///< absent without [dynamics]
  std::optional<PairResponseResult> response{};
  std::vector<ShareRow> shares{};
  std::vector<SpeedRow> speeds{};
  StudyResults studies{};
  std::vector<std::pair<std::string, double>> timings{};
  double peak_memory_MB = 0;
  PlanCost cost{};  ///< predicted and actual, of the steps that were not reused
  std::shared_ptr<const Reuse> reuse{};
};

/// Everything the scene asks for, into options.out. Throws what the steps throw.
PairRunResult run_pair(const Scene& scene, const RunOptions& options);

/// Rough wall time of one response on one core, s.
[[nodiscard]] double pair_seconds(const Scene& scene);
/// Time integration of one response: of `mesh_cycles`, else of the window that confirms it.
[[nodiscard]] double pair_marching_seconds(const Scene& scene);

/// What will be modelled and why (pair_plan.cc).
[[nodiscard]] Plan make_pair_plan(const Scene& scene, const PairGeometry& geometry, int threads = 1);
/// The responses of a run, as one step: the scene's own, and those that part the transmission error by its causes.
[[nodiscard]] std::vector<PlannedResponse> pair_responses(const Scene& scene, int threads);

[[nodiscard]] std::string pair_summary_json(const PairRunResult& result);  ///< pair_summary.cc
[[nodiscard]] std::string pair_summary_text(const PairRunResult& result);

}  // namespace annulus::app
