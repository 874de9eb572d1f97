#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/plan/plan.h"
#include "app/reuse.h"
#include "app/scene/scene.h"
#include "app/stage/coupling_effect.h"
#include "app/stage/gear_geometry.h"
#include "app/stage/mesh_result.h"
#include "app/stage/reference.h"
#include "app/stage/stage_response.h"
#include "app/study/study_result.h"

/// annulus from a scene file to a report. Start reading here: the whole program is six functions in a row,
///
///     Scene ─► GearGeometry ─► contact ─► StiffnessTable ─► DynamicResponse ─► report
///
/// and `run` calls them. Every stage leaves files from which the next one can start again: a result whose inputs have
/// not changed is read back instead of computed.
namespace annulus::app {

struct RunOptions {
  std::filesystem::path out{};                    ///< folder of all results
  std::optional<std::filesystem::path> tables{};  ///< where to look for earlier tables; absent: `out`
  int threads = 1;
  bool with_dynamics = true;  ///< false: meshes, transmission error and stiffness only
  // Set by the run itself (with_reuse); without them nothing is noted and every tooth is condensed.
  std::shared_ptr<Reuse> reuse{};
  std::shared_ptr<fem::CondensedStore> store{};
  bool for_study = false;  ///< what is computed belongs to a changed scene
  /// Changes how a mesh is solved from what was planned (measurements); absent: as planned.
  std::function<MeshModel(const MeshModel& planned)> remodel{};
};

struct RingResult {
  std::string name;
  MeshResult mesh;                                  ///< ring-planet mesh
  std::optional<StageResponse> response{};          ///< absent without dynamics
  std::optional<CouplingEffect> coupling_effect{};  ///< absent where the coupling of the planets was not looked at
  double response_seconds = 0;                      ///< wall, of both; little when they were read back
};

/// Everything a report needs.
struct RunResult {
  Scene scene;
  GearGeometry geometry;
  Plan plan;
  MeshResult sun_mesh;  ///< solved once, the same for all rings
  std::vector<RingResult> rings{};
  std::optional<Reference> reference{};                   ///< published results to compare with
  StudyResults studies{};                                 ///< sweeps, samples, sensitivity, as the scene asks
  std::vector<std::pair<std::string, double>> timings{};  ///< wall seconds by stage, then "other" and "total"
  double peak_memory_MB = 0;
  PlanCost cost{};  ///< predicted and actual, of the steps that were not reused
  std::shared_ptr<const Reuse> reuse{};
};

// 1. Scene: what the user wants, checked, SI (scene.h):
//      Scene read_scene(const std::filesystem::path& file);
// 2. Geometry: gears, working angles, phasing, operating point (gear_geometry.h):
//      GearGeometry make_geometry(const Scene& scene);

// 3. Contact: gmsh meshes, elastic bodies, contact of one gear mesh at every position and load. Writes meshes to
//    `folders` (OUT/<ring>/mesh; the sun mesh goes to every ring's folder).
[[nodiscard]] fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options);

// 4. Stiffness table with pictures, shares and invariants: read back if unchanged, else solved, packed and saved.
[[nodiscard]] MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                                        const std::vector<std::string>& rings, const RunOptions& options);

//    The same for a mesh that is computed, whatever its stage; kept in OUT/<folder> for each folder.
[[nodiscard]] MeshResult computed_stiffness(const MeshModel& model, const std::vector<std::string>& folders,
                                            const RunOptions& options);

// 5. Dynamics of one ring on its tables: read back if unchanged, else simulated and saved.
[[nodiscard]] StageResponse dynamic_response(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                             const RunOptions& options);

// Where the scene asks for [[sweep]], [monte_carlo] or [sensitivity], stages 1 to 5 again for changed scenes
// (studies.h).

// 6. Report: OUT/report.html and OUT/summary.json (report.h, summary.h).

/// All stages of a planetary set. Throws what the stages throw; what is finished by then stays on disk and is reused.
/// Scenes of any kind: run_scene (stage_kinds.h).
RunResult run(const Scene& scene, const RunOptions& options);

}  // namespace annulus::app
