#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/system_run.h"
#include "app/plan/gear_geometry.h"
#include "app/systems/planetary/coupling_effect.h"
#include "app/systems/planetary/stage_response.h"

/// A planetary stage from its meshes to its report: one variant per ring.
namespace annulus::app {

struct RingResult {
  std::string name;
  MeshResult mesh;                                  ///< ring-planet mesh
  std::optional<StageResponse> response{};          ///< absent without dynamics
  std::optional<CouplingEffect> coupling_effect{};  ///< absent where the coupling of the planets was not looked at
  double response_seconds = 0;                      ///< wall, of both; little when they were read back
};

struct RunResult final : SystemRun {
  explicit RunResult(const Scene& of);

  GearGeometry geometry;
  MeshResult sun_mesh{};  ///< solved once, the same for all rings
  std::vector<RingResult> rings{};

  void solve_meshes(const RunOptions& options) override;
  void respond(const RunOptions& options) override;
  [[nodiscard]] std::vector<const MeshResult*> meshes() const override;
  [[nodiscard]] std::vector<VariantFigures> variants() const override;
  [[nodiscard]] std::optional<CostRun> actual(const CostStep& step) const override;
  [[nodiscard]] std::vector<const MeshResult*> model_tables() const override { return meshes(); }
  [[nodiscard]] Json summary() const override;      // summary.cc
  [[nodiscard]] std::string text() const override;  // summary.cc
  [[nodiscard]] Page report() const override;
};

/// Stiffness table of the sun mesh (in OUT) or of a ring mesh with its coupling (in OUT/<ring>): from the cache if
/// unchanged, else solved. Throws what solving throws, with its place in the scene.
[[nodiscard]] MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                                        const RunOptions& options);

/// Dynamics of one ring on its tables: read back if unchanged, else simulated and saved.
[[nodiscard]] StageResponse dynamic_response(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                             const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                             const RunOptions& options);

/// All steps of a run of a planetary scene.
[[nodiscard]] RunResult run(const Scene& scene, const RunOptions& options);

}  // namespace annulus::app
