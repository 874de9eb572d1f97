#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_solve.h"
#include "app/model/run_options.h"
#include "app/model/system_run.h"
#include "core/json.h"

/// annulus from a scene file to a report. Start reading here: the whole program is six functions in a row,
///
///     Scene ─► GearSystem ─► contact ─► StiffnessTable ─► lumped model ─► report
///
/// and `run_system` calls them, for any kind of gear system. Every step caches its result: one whose inputs have not
/// changed is read back instead of computed.
namespace annulus::app {

// 1. Scene: what the user wants, checked, SI (scene/scene_files.h):
//      Scene read_scene(const std::filesystem::path& file);
// 2. Gear system: gears, working angles, phasing, operating point, what is to be solved and why (model/gear_system.h):
//      std::unique_ptr<GearSystem> make_system(const Scene& scene);

// 3. Contact: gmsh meshes, elastic bodies, contact of one gear mesh at every position and load; packed into a
// 4. stiffness table with pictures, shares and invariants (model/mesh_solve.h):
//      MeshResult computed_stiffness(const MeshModel& model, const std::string& folder, const RunOptions& options);

// 5. Lumped model on the tables: GearSystem::respond (model/gear_system.h). Where the scene asks for [[sweep]],
//    [monte_carlo] or [sensitivity], steps 2 to 5 again for changed scenes (study/studies.h).

// 6. Report: OUT/report.html, OUT/summary.json and OUT/figures.csv.

/// All steps of a run. Throws what the steps throw; what is finished by then stays on disk and is reused.
[[nodiscard]] std::shared_ptr<const SystemRun> run_system(const Scene& scene, const RunOptions& options);

/// The summary of a finished run for the standard output.
[[nodiscard]] std::string run_text(const SystemRun& run);
/// summary.json of a finished run.
[[nodiscard]] Json summary_json(const SystemRun& run);

}  // namespace annulus::app
