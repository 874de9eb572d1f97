#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/cost_model.h"
#include "app/plan/mesh_model.h"
#include "core/not_known.h"

namespace annulus::app {

enum class CostKind { mesh, coupling, response, files, studies };
[[nodiscard]] const char* to_text(CostKind kind);

/// One step of a run: what it will cost and, after it, what it did.
struct CostStep {
  CostKind kind = CostKind::mesh;
  std::string label{};                     ///< for people: "sun-planet mesh", "coupling through 'pinned'"
  std::string variant{};                   ///< empty for what all variants share, and for studies
  CostRun size{};                          ///< as predicted; of no meaning for files and studies
  std::string cause{};                     ///< "it follows from dynamics.mesh_cycles": what would change its cost
  PredictedCost predicted{};               ///< infinite where time integration needs endless steps
  std::optional<PredictedCost> further{};  ///< of a mesh, if its elements turn out not to be accurate enough
  std::string follow{};                    ///< what is solved then: "quadratic elements follow"
  double expected_error = not_known;       ///< relative, of a mesh's stiffness; NaN: not known
  std::optional<CostRun> actual{};         ///< absent before the run and for what was reused
};

struct PlanCost {
  std::vector<CostStep> steps;
  int threads = 1;
  double pace = 1;  ///< by which the predicted times are scaled (machine_pace)

  [[nodiscard]] bool empty() const { return steps.empty(); }
  /// With finer or quadratic elements wherever they may have to follow: what limits are compared with.
  [[nodiscard]] PlanCost at_worst() const;
  /// s: meshes and couplings one after the other, responses side by side.
  [[nodiscard]] double seconds() const;
  [[nodiscard]] double peak_MB() const;
  /// The largest expected error of all meshes; NaN when one is not known or none is computed.
  [[nodiscard]] double expected_error() const;
  /// With predicted times of a machine of this pace.
  [[nodiscard]] PlanCost at_pace(double machine) const;
  /// Wall time that its steps took together, counted as in seconds().
  [[nodiscard]] double actual_seconds() const;
};

/// What solving a computed mesh is.
[[nodiscard]] Work work_of(const MeshModel& model);
/// The size of solving one computed mesh, its level as the model expects it.
[[nodiscard]] CostRun mesh_size(const MeshModel& model);
/// The same of one level with elements of a degree.
[[nodiscard]] CostRun level_size(const MeshModel& model, int degree, int level);
/// The size with the quadratic elements that follow where linear ones, planned first, are not accurate enough.
[[nodiscard]] std::optional<CostRun> quadratic_size(const MeshModel& model);
/// The size with one level more, where the error of the planned one is expected near the wanted accuracy: that of two
/// meshes differs by a factor of 3.
[[nodiscard]] std::optional<CostRun> finer_size(const MeshModel& model);

/// A response of the lumped model, of the size `size`.
struct PlannedResponse {
  std::string label, variant;
  CostRun size;
  /// Processor time that the search for other motions may take beyond that of `size`, at worst.
  double search_s = 0;
  double study_s = 0;         ///< processor time of the same response in a study, without a search
  double study_search_s = 0;  ///< of the search for other motions, where a study has it
  double sample_s = 0;  ///< the same without its motion, as samples and searches ask for it (Answer::without_motion)
};

/// Responses on changed tables that carry the errors of `tables` tables (dynamics::propagate_errors): each of them
/// stiffer and more rippled, all with fewer phases and with sudden jumps, and the unchanged ones solved in the same
/// way.
[[nodiscard]] int comparisons(int tables);

/// What one study will take.
struct StudyPlan {
  std::string name;            ///< "[[sweep]] 1", as in the scene
  std::string description;     ///< "stage.sun_speed_rpm from 500 to 2000 r/min, 31 values"
  long responses = 0;          ///< over all rings
  int tables = 0;              ///< stiffness tables to be solved besides the nominal ones
  double seconds = 0;          ///< rough processor time of the responses, tables not counted
  CostRun table{};             ///< the most expensive of the tables
  int tasks = 0;               ///< that threads can share; 0: as many as responses
  bool tables_counted = true;  ///< one by one, not estimated from some of the cases
};

/// Predicted cost of a run. `coupled`: whether a computed mesh is coupled with the others through its ring, which is a
/// step of its own.
[[nodiscard]] PlanCost plan_cost(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses,
                                 const std::vector<StudyPlan>& studies, int threads,
                                 const std::function<bool(const MeshModel&)>& coupled);

/// "12 s", "3 min", "850 ms"; "not known" for NaN and infinite times.
[[nodiscard]] std::string duration_text(double seconds);
/// "640 MB", "12.5 GB"; "not known" for NaN.
[[nodiscard]] std::string memory_text(double MB);

}  // namespace annulus::app
