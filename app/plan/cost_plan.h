#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/cost_model.h"
#include "app/plan/mesh_model.h"
#include "app/plan/study_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

enum class CostKind { mesh, coupling, response, studies };
[[nodiscard]] const char* to_text(CostKind kind);

/// One step of a run: what it will cost and, after it, what it did.
struct CostStep {
  CostKind kind = CostKind::mesh;
  std::string label;                ///< for people: "sun-planet mesh", "coupling through 'pinned'"
  std::string ring;                 ///< empty for the sun mesh and studies
  CostRun size;                     ///< as predicted; of no meaning for studies
  PredictedCost predicted;          ///< NaN: nobody has measured such a step
  double integration_s = 0;         ///< s of `predicted`: time integration, beyond what laws of measured runs know
  double expected_error = 0;        ///< relative, of a mesh's stiffness; NaN: not known
  std::optional<CostRun> actual{};  ///< absent before the run and for what was reused
};

struct PlanCost {
  std::vector<CostStep> steps;
  int threads = 1;

  [[nodiscard]] bool empty() const { return steps.empty(); }
  /// s: meshes and couplings one after the other, responses side by side. NaN when a step is not known.
  [[nodiscard]] double seconds() const;
  [[nodiscard]] double peak_MB() const;
  /// The largest expected error of all meshes; NaN when one is not known or none is computed.
  [[nodiscard]] double expected_error() const;
  /// The steps that were not reused, and the wall time they took together, counted as in seconds().
  [[nodiscard]] PlanCost done() const;
  [[nodiscard]] double actual_seconds() const;
};

/// Kind of cost of a computed mesh (CostRun::kind).
[[nodiscard]] std::string cost_kind(const MeshModel& model);

/// The size of solving one computed mesh, its level as the model expects it. `threads` of the whole run.
[[nodiscard]] CostRun mesh_size(const MeshModel& model, int threads, const CostModel& costs);

/// A response of the lumped model, of the size `size`.
struct PlannedResponse {
  std::string label, ring;
  CostRun size;
  double integration_s = 0;  ///< s, of all mesh cycles that are integrated in time
};
/// Rough stiffness of a mesh before it is solved, N/m: the given mean, else that of steel teeth of the face width.
[[nodiscard]] double rough_stiffness(const Scene& scene, const MeshInput& mesh);
/// Predicted cost of a run. `coupled`: whether a computed mesh is coupled with the others through its ring, which is a
/// step of its own.
[[nodiscard]] PlanCost plan_cost(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses,
                                 const std::vector<StudyPlan>& studies, int threads, const CostModel& costs,
                                 const std::function<bool(const MeshModel&)>& coupled);

/// "12 s", "3 min", "850 ms"; "not known" for NaN.
[[nodiscard]] std::string duration_text(double seconds);
/// "640 MB"; "not known" for NaN.
[[nodiscard]] std::string memory_text(double MB);

}  // namespace annulus::app
