#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model/stiff_supports.h"
#include "app/model/system_run.h"
#include "app/report/section.h"
#include "app/systems/helical_pair/pair_errors.h"
#include "app/systems/helical_pair/pair_stiffness.h"
#include "app/systems/shared/space_results.h"
#include "core/csv.h"
#include "core/json.h"
#include "dynamics/modes/modes.h"
#include "dynamics/systems/helical_pair/pair_figures.h"

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
    double acceleration = 0;        ///< m/s^2, of the teeth
    double peak_to_peak_force = 0;  ///< N, largest - smallest mesh force
    double peak_to_peak_te = 0;     ///< m, peak-to-peak u_1 + u_2
  };
  double pinion_speed = 0;                          ///< rad/s
  Motion all{}, errors_alone{}, stiffness_alone{};  ///< errors alone: at constant mean stiffness
  std::string failure{};
};

/// The answer of a pair, as it is cached.
struct PairResponseResult {
  dynamics::PairResponse figures;  ///< without the series; errors with all their parts
  FigureSet results;               ///< by key, with the parts of their errors
  dynamics::Modes modes;
  Csv series;            ///< one row per sample: time, DOFs, force, transmission error
  Csv spectrum;          ///< of the mesh force
  SpaceResults space{};  ///< of a pair in space
  std::vector<ShareRow> shares{};
  std::vector<SpeedRow> speeds{};
};

struct PairRunResponse final : RunResponse {
  dynamics::HelicalPair pair;
  PairResponseResult response{};
};

struct PairRunResult : RunView {
  explicit PairRunResult(const SystemRun& run);

  PairGeometry geometry;
  PairMesh mesh;
  std::vector<MeanStiffness> stiffnesses;
  PairErrors errors;
  // Null or empty without [dynamics]:
  const dynamics::HelicalPair* pair = nullptr;
  const PairResponseResult* response = nullptr;
  std::vector<ShareRow> shares{};
  std::vector<SpeedRow> speeds{};
};

/// The response of the scene on the stiffness of its mesh, and those that divide the transmission error by its causes;
/// files in OUT/dynamics.
[[nodiscard]] std::unique_ptr<PairRunResponse> pair_response(const Scene& scene, const MeshResult& mesh,
                                                             const RunOptions& options);

[[nodiscard]] Json pair_summary(const PairRunResult& result);      ///< members of summary.json (pair_summary.cc)
[[nodiscard]] std::string pair_text(const PairRunResult& result);  ///< for the standard output (pair_summary.cc)
[[nodiscard]] Page pair_report(const PairRunResult& result);       ///< report.html (report/pair_report.cc)

/// All steps of a run of a scene of this kind.
[[nodiscard]] PairRunResult run_pair(const Scene& scene, const RunOptions& options);

/// The pair before its stiffness is computed (pair_plan.cc). Needs [dynamics].
[[nodiscard]] dynamics::HelicalPair rough_pair(const Scene& scene, RoughCourse course = RoughCourse::constant);
/// What a plan reports of a pair (pair_plan.cc).
void describe_pair(const Scene& scene, const PairGeometry& geometry, Plan& plan);
/// The responses of a run, as one step: the scene's own, and those that divide the transmission error by its causes.
[[nodiscard]] std::vector<PlannedResponse> pair_responses(const Scene& scene);

}  // namespace annulus::app
