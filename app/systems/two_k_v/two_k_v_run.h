#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/system_run.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "app/systems/two_k_v/two_k_v_vibration.h"

/// From a 2K-V scene to its report.
namespace annulus::app {

/// The stage on one pair of mesh stiffnesses.
struct TwoKVCase {
  Scene scene;
  TwoKVTables tables;
  // Absent without [dynamics]:
  std::optional<dynamics::TwoKVStage> stage{};  ///< tables at the nominal load
  std::optional<TwoKVVibration> vibration{};
  std::optional<TwoKVMotion> motion{};
  double response_seconds = 0;  ///< wall, vibration and motion
};

struct TwoKVResult final : SystemRun {
  explicit TwoKVResult(const Scene& of);

  std::optional<dynamics::ArcToothMesh> arc;  ///< absent when its dimensions are not given
  TwoKVCase own;                              ///< the scene as it is
  std::optional<TwoKVCase> computed{};        ///< with computed stiffness where the scene asks for a comparison

  /// The sun meshes; writes stiffness tables of both meshes to options.out, of the compared case to
  /// options.out/computed.
  void solve_meshes(const RunOptions& options) override;
  /// Vibration and motion of both cases.
  void respond(const RunOptions& options) override;
  [[nodiscard]] std::vector<const MeshResult*> meshes() const override;
  [[nodiscard]] std::vector<VariantFigures> variants() const override;
  [[nodiscard]] std::optional<CostRun> actual(const CostStep& step) const override;
  [[nodiscard]] std::vector<const MeshResult*> model_tables() const override { return {&own.tables.sun}; }
  [[nodiscard]] Json summary() const override;      // two_k_v_summary.cc
  [[nodiscard]] std::string text() const override;  // two_k_v_summary.cc
  [[nodiscard]] Page report() const override;
};

/// Stiffness of the sun mesh: solved into OUT/`folder` or cached, or prescribed.
[[nodiscard]] MeshResult two_k_v_stiffness(const Scene& scene, const MeshModel& sun, const std::string& folder,
                                           const RunOptions& options);

/// All steps of a run of a scene of this kind.
[[nodiscard]] TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& options);

/// The results of a reducer: those of its meshes, then those of its lumped model.
[[nodiscard]] const std::vector<FigureSpec>& two_k_v_run_figures();

/// What a plan reports of a reducer (two_k_v_plan.cc).
void describe_two_k_v(const Scene& scene, Plan& plan);
/// The meshes that are solved or given: where the scene compares, those of the comparison.
[[nodiscard]] std::vector<MeshModel> two_k_v_meshes(const Scene& scene);
/// One for the scene, one for a comparison if it asks for it.
[[nodiscard]] std::vector<PlannedResponse> two_k_v_responses(const Scene& scene);

}  // namespace annulus::app
