#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/model/solved_coupling.h"
#include "app/plan/mesh_model.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

struct MeshResult;
struct RunOptions;

/// What the lumped model takes of it, and why.
struct CouplingChoice {
  RimCoupling taken = RimCoupling::none;
  std::string reason;
};
[[nodiscard]] CouplingChoice coupling_choice(const Scene& scene, const SolvedCoupling& solved);
/// Whether it is left out and so far below the wanted accuracy that what it changes need not be looked at: a tenth of
/// it, and no mode of the ring within reach.
[[nodiscard]] bool is_negligible(const Scene& scene, const SolvedCoupling& solved);
/// The coupling as a stage takes it: without modes for `statical`; nothing for `none`.
[[nodiscard]] std::shared_ptr<const RingCoupling> taken_coupling(const SolvedCoupling& solved, RimCoupling taken);

/// The stage with the static coupling of its ring that was solved and left out as negligible; nothing where it was not.
[[nodiscard]] std::optional<dynamics::PlanetaryStage> with_omitted_coupling(const dynamics::PlanetaryStage& stage,
                                                                            const MeshResult& ring_mesh);
/// Whether the scene lets this mesh be coupled: dynamics wanted, a computed ring, several planets, coupling not ruled
/// out. It takes elements: with formulas it is solved where the planner chose these for a ring on single supports, and
/// the accuracy is not very rough.
[[nodiscard]] bool may_be_coupled(const Scene& scene, const MeshModel& model);
/// The same for an equilibrium, which needs no dynamics.
[[nodiscard]] bool may_be_coupled_at_rest(const Scene& scene, const MeshModel& model);
/// From the cache if unchanged, else solved; in `folder` (OUT/<ring>) as ring_coupling.csv, ring_modes.csv and
/// ring_compliance.csv.
/// `mesh_compliance` (m/N) is that of the mesh by its table.
[[nodiscard]] SolvedCoupling solve_coupling(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                                            double mesh_compliance, const RunOptions& options,
                                            const std::filesystem::path& folder);

}  // namespace annulus::app
