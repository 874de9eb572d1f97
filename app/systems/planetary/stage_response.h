#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/results/content_id.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/propagated_errors.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/stage_modes.h"
#include "app/systems/planetary/stage_motion.h"
#include "core/csv.h"
#include "core/json.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// The lumped model's answer for one ring.
struct StageResponse {
  dynamics::DynamicResponse figures;  ///< all but the time series; errors with all their parts
  FigureSet errors;                   ///< results of meshes and shafts with the parts of their errors
  StageModes modes;
  StageMotion motion;
  Csv load_sharing;  ///< per mesh cycle: N F / sum F of every branch, forces averaged over the cycle
  /// Per mesh cycle and mesh: smallest F and largest |F| over the nominal force, largest |F| over the mean of the
  /// cycle.
  Csv force_factors;
  Csv waveform;             ///< F / mean mesh force of every branch over the first mesh cycles of the window
  Csv sharing_waveform;     ///< N F / sum F of every branch over the same time
  Csv spectrum;             ///< force amplitude of every branch over frequency and mesh order
  Csv gauge_spectrum;       ///< of strain gauges (gauge_strain.h); empty without
  std::string time_series;  ///< the file of all motions and forces; empty once it is written
  bool reused = false;
};

/// A prescribed stiffness acts along the normal of the flanks, the lumped model of a stage along their line of action
/// in the transverse section: its mean times cos^2 of the base helix angle.
[[nodiscard]] MeshInput in_transverse_section(const MeshInput& mesh, const geometry::GearPair& pair);

/// The stage of one ring as far as it follows from the gears: kinematics, errors of its bodies, speeds, torque.
[[nodiscard]] dynamics::PlanetaryStage stage_kinematics(const Scene& scene, const GearGeometry& geometry,
                                                        std::size_t ring);
/// The same with its meshes, without masses, supports and what needs [dynamics].
[[nodiscard]] dynamics::PlanetaryStage unsupported_stage(const Scene& scene, const GearGeometry& geometry,
                                                         std::size_t ring, const MeshResult& sun_mesh,
                                                         const MeshResult& ring_mesh);
/// The stage of one ring as lumped masses: the scene, its kinematics and its mesh stiffnesses put together.
[[nodiscard]] dynamics::PlanetaryStage make_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                                  const MeshResult& sun_mesh, const MeshResult& ring_mesh);
[[nodiscard]] dynamics::SimulationOptions simulation_options(const Scene& scene, const dynamics::PlanetaryStage& stage);

/// Identity of everything the response depends on.
[[nodiscard]] std::string response_id(const dynamics::PlanetaryStage& stage, const dynamics::SimulationOptions& options,
                                      const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// Simulates, and propagates the errors of the tables into the results.
[[nodiscard]] StageResponse simulate_stage(const dynamics::PlanetaryStage& stage,
                                           const dynamics::SimulationOptions& options, const StageTables& tables);
/// figures.json: results and modes of one response, with the identity of its inputs (response_json.cc).
[[nodiscard]] Json response_json(const StageResponse& response, const std::string& id);
/// Writes all files of a response into `folder` (OUT/<ring>/dynamics).
void save(const StageResponse& response, const std::string& id, const std::filesystem::path& folder);

}  // namespace annulus::app
