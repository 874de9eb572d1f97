#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/pipeline.h"
#include "app/two_k_v/two_k_v_model.h"
#include "app/two_k_v/two_k_v_motion.h"
#include "app/two_k_v/two_k_v_vibration.h"

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

/// Everything a report needs.
struct TwoKVResult {
  Plan plan;
  std::optional<dynamics::ArcToothMesh> arc;  ///< absent when its dimensions are not given
  TwoKVCase own;                              ///< the scene as it is
  std::optional<TwoKVCase> computed{};        ///< with computed stiffness where the scene asks for a comparison
  std::optional<Reference> reference{};
  StudyResults studies{};
  std::vector<std::pair<std::string, double>> timings{};
  double peak_memory_MB = 0;
  PlanCost cost{};  ///< predicted and actual, of the steps that were not reused
  std::shared_ptr<const Reuse> reuse{};

  [[nodiscard]] const Scene& scene() const { return own.scene; }
};

[[nodiscard]] Plan make_two_k_v_plan(const Scene& scene, int threads = 1);
/// The meshes that are solved or given: where the scene compares, those of the comparison.
[[nodiscard]] std::vector<MeshModel> two_k_v_meshes(const Scene& scene);
/// One for the scene, one for a comparison if it asks for it.
[[nodiscard]] std::vector<PlannedResponse> two_k_v_responses(const Scene& scene);

/// Writes stiffness tables, dynamics/*.csv, figures, summary.json and report.html to options.out; those of the compared
/// case to options.out/computed. Throws what the stages throw; what is finished by then is reused.
TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& options);

/// Tables a changed scene needs and the nominal one does not have.
[[nodiscard]] std::vector<std::string> two_k_v_tables_to_solve(const Scene& nominal, const Scene& changed);
/// Rough wall time of one response on one core.
[[nodiscard]] double two_k_v_seconds(const Scene& scene);
/// Time integration of one response: of `mesh_cycles`, else of the turns of the crank that shooting takes.
[[nodiscard]] double two_k_v_marching_seconds(const Scene& scene);

[[nodiscard]] std::string two_k_v_summary(const TwoKVResult& result);  ///< JSON (two_k_v_summary.cc)
[[nodiscard]] std::string two_k_v_text(const TwoKVResult& result);     ///< for standard output

}  // namespace annulus::app
