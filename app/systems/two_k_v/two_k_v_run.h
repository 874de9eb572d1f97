#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/gear_system.h"
#include "app/model/system_run.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "app/systems/two_k_v/two_k_v_vibration.h"

/// A run of a 2K-V stage: the scene as it is, and with computed stiffness where it asks for a comparison.
namespace annulus::app {

struct TwoKVResponse final : RunResponse {
  TwoKVVibration vibration;
  TwoKVMotion motion;
};

/// The stage on one pair of mesh stiffnesses.
struct TwoKVCase {
  Scene scene;
  TwoKVTables tables;
  // Absent without [dynamics]:
  std::optional<dynamics::TwoKVStage> stage{};  ///< tables at the nominal load
  const TwoKVVibration* vibration = nullptr;
  const TwoKVMotion* motion = nullptr;
};

struct TwoKVResult : RunView {
  explicit TwoKVResult(const SystemRun& run);

  std::optional<dynamics::ArcToothMesh> arc;  ///< absent when its dimensions are not given
  TwoKVCase own;                              ///< the scene as it is
  std::optional<TwoKVCase> computed{};        ///< with computed stiffness where the scene asks for a comparison
};

/// The sun mesh and the arc mesh of the scene, then those of compared_scene that differ.
[[nodiscard]] std::vector<MeshModel> two_k_v_run_meshes(const Scene& scene);
[[nodiscard]] std::vector<RunVariant> two_k_v_run_variants(const Scene& scene);
/// Stiffness of one of them; a sun mesh that is solved for the comparison alone has its files in OUT/computed.
[[nodiscard]] MeshResult two_k_v_stiffness(const Scene& scene, const MeshModel& mesh, const RunOptions& options);
/// Vibration and motion of a variant; `tables`: its sun mesh and arc mesh. `published`: first frequencies, Hz.
[[nodiscard]] std::unique_ptr<TwoKVResponse> two_k_v_response(const Scene& scene, const RunVariant& variant,
                                                              const std::vector<const MeshResult*>& tables,
                                                              const std::vector<double>& published,
                                                              const RunOptions& options);

[[nodiscard]] Json two_k_v_summary(const TwoKVResult& result);      ///< members of summary.json (two_k_v_summary.cc)
[[nodiscard]] std::string two_k_v_text(const TwoKVResult& result);  ///< for the standard output (two_k_v_summary.cc)
[[nodiscard]] Page reducer_report(const TwoKVResult& result);       ///< report.html (report/reducer_report.cc)

/// All steps of a run of a scene of this kind.
[[nodiscard]] TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& options);

/// What a plan reports of a reducer (two_k_v_plan.cc).
void describe_two_k_v(const Scene& scene, Plan& plan);
/// The meshes that are solved or prescribed: where the scene compares, those of the comparison.
[[nodiscard]] std::vector<MeshModel> two_k_v_meshes(const Scene& scene);
/// One for the scene, one for a comparison if it asks for it.
[[nodiscard]] std::vector<PlannedResponse> two_k_v_responses(const Scene& scene);
/// The stage with rough stiffness, before anything is solved. Needs [dynamics].
[[nodiscard]] dynamics::TwoKVStage rough_two_k_v(const Scene& scene);

}  // namespace annulus::app
