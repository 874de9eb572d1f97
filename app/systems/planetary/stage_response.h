#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/plan/gear_geometry.h"
#include "app/results/content_id.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/carried_errors.h"
#include "app/systems/planetary/stage_modes.h"
#include "app/systems/planetary/stage_motion.h"
#include "core/csv.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// The lumped model's answer for one ring, and what is kept of it in OUT/<ring>/dynamics.
struct StageResponse {
  dynamics::DynamicResponse figures;  ///< all but the time series; errors with all their parts
  ResponseErrors errors;              ///< the parts of the errors
  StageModes modes;
  StageMotion motion;
  Csv load_sharing;      ///< per mesh cycle: N F / sum F of every branch, forces averaged over the cycle
  Csv dynamic_factor;    ///< per mesh cycle: smallest and largest F / mean mesh force of every branch
  Csv waveform;          ///< F / mean mesh force of every branch over the first mesh cycles of the window
  Csv sharing_waveform;  ///< N F / sum F of every branch over the same time
  Csv spectrum;          ///< force amplitude of every branch over frequency and mesh order
  bool reused = false;
};

/// The stage of one ring as lumped masses: the scene, its kinematics and its mesh stiffnesses put together.
[[nodiscard]] dynamics::PlanetaryStage make_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                                  const MeshResult& sun_mesh, const MeshResult& ring_mesh);
[[nodiscard]] dynamics::SimulationOptions simulation_options(const Scene& scene, const dynamics::PlanetaryStage& stage);

/// Identity of everything the response depends on.
[[nodiscard]] std::string response_id(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& options,
                                      const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// Simulates, carries the errors of the tables into the figures, writes all files of `folder` (OUT/<ring>/dynamics)
/// including the time series, and returns what is kept.
[[nodiscard]] StageResponse simulate_and_save(const dynamics::PlanetaryStage& stage,
                                              const dynamics::SimulationOptions& options, const StageTables& tables,
                                              const std::string& id, const std::filesystem::path& folder);
/// All files of a response in its folder.
[[nodiscard]] std::vector<std::string> response_files();
/// What `simulate_and_save` wrote. Throws InputError where files are missing or damaged.
[[nodiscard]] StageResponse load_response(const std::filesystem::path& folder);

}  // namespace annulus::app
