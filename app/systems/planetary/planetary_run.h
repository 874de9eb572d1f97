#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/system_run.h"
#include "app/report/section.h"
#include "app/systems/planetary/coupling_effect.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/tolerance_sharing.h"
#include "core/json.h"

/// A run of a planetary stage: one variant per ring.
namespace annulus::app {

/// The answer of the stage with one of its rings.
struct RingResponse final : RunResponse {
  StageResponse stage;
  std::optional<CouplingEffect> coupling_effect{};  ///< absent where the coupling of the planets was not looked at
  std::optional<ToleranceSharing> tolerances{};     ///< absent without [tolerances]
};

struct RingResult {
  std::string name;
  const MeshResult& mesh;                           ///< ring-planet mesh
  const StageResponse* response = nullptr;          ///< null without dynamics
  const CouplingEffect* coupling_effect = nullptr;  ///< null where the coupling of the planets was not looked at
  const ToleranceSharing* tolerances = nullptr;     ///< null without [tolerances]
};

struct RunResult : RunView {
  explicit RunResult(const SystemRun& run);

  GearGeometry geometry;
  const MeshResult& sun_mesh;  ///< solved once, the same for all rings
  std::vector<RingResult> rings{};
};

/// Stiffness table of the sun mesh (in OUT) or of a ring mesh with its coupling (in OUT/<ring>): from the cache if
/// unchanged, else solved. Throws what solving throws, with its place in the scene.
[[nodiscard]] MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                                        const RunOptions& options);

/// Dynamics of one ring on its tables: read back if unchanged, else simulated and saved.
[[nodiscard]] std::unique_ptr<RingResponse> ring_response(const Scene& scene, const GearGeometry& geometry,
                                                          std::size_t ring, const MeshResult& sun_mesh,
                                                          const MeshResult& ring_mesh, const RunOptions& options);

[[nodiscard]] Json stage_summary(const RunResult& result);      ///< members of summary.json (summary.cc)
[[nodiscard]] std::string stage_text(const RunResult& result);  ///< for the standard output (summary.cc)
[[nodiscard]] Page stage_report(const RunResult& result);       ///< report.html (report/stage_report.cc)

/// All steps of a run of a planetary scene.
[[nodiscard]] RunResult run(const Scene& scene, const RunOptions& options);

}  // namespace annulus::app
