#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/system_run.h"
#include "app/systems/helical_pair/pair_errors.h"
#include "app/systems/helical_pair/pair_stiffness.h"
#include "core/csv.h"
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
    double acceleration = 0;  ///< m/s^2, of the teeth
    double force_range = 0;   ///< N, largest - smallest mesh force
    double te_range = 0;      ///< m, peak-to-peak u_1 + u_2
  };
  double pinion_speed = 0;                          ///< rad/s
  Motion all{}, errors_alone{}, stiffness_alone{};  ///< errors alone: at constant mean stiffness
  std::string failure{};
};

struct PairResponseResult {
  dynamics::PairResponse figures;  ///< without the series; errors with all their parts
  FigureSet results{};             ///< by key, with the parts of their errors; frequencies too
  dynamics::Modes modes;
  Csv series;    ///< one row per sample: time, DOFs, force, transmission error
  Csv spectrum;  ///< of the mesh force
};

struct PairRunResult final : SystemRun {
  explicit PairRunResult(const Scene& of);

  PairGeometry geometry;
  MeshResult not_solved{};  ///< the model alone, of a mesh that is not computed
  PairMesh mesh{};
  std::vector<MeanStiffness> stiffnesses{};
  PairErrors errors{};
  std::optional<dynamics::HelicalPair> pair{};  ///< absent without [dynamics]
  std::optional<PairResponseResult> response{};
  std::vector<ShareRow> shares{};
  std::vector<SpeedRow> speeds{};

  void solve_meshes(const RunOptions& options) override;
  void respond(const RunOptions& options) override;
  [[nodiscard]] std::vector<const MeshResult*> meshes() const override;
  [[nodiscard]] std::vector<VariantFigures> variants() const override;
  [[nodiscard]] std::optional<CostRun> actual(const CostStep& step) const override;
  [[nodiscard]] std::vector<const MeshResult*> model_tables() const override;
  [[nodiscard]] Json summary() const override;      // pair_summary.cc
  [[nodiscard]] std::string text() const override;  // pair_summary.cc
  [[nodiscard]] Page report() const override;
};

/// All steps of a run of a scene of this kind.
[[nodiscard]] PairRunResult run_pair(const Scene& scene, const RunOptions& options);

/// The results of a pair: those of its mesh, then those of its lumped model.
[[nodiscard]] const std::vector<FigureSpec>& pair_run_figures();

/// What a plan reports of a pair (pair_plan.cc).
void describe_pair(const Scene& scene, const PairGeometry& geometry, Plan& plan);
/// The responses of a run, as one step: the scene's own, and those that divide the transmission error by its causes.
[[nodiscard]] std::vector<PlannedResponse> pair_responses(const Scene& scene);

}  // namespace annulus::app
