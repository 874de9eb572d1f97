#pragma once

#include <optional>
#include <string>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/scene/scene.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/two_k_v/arc_tooth.h"
#include "dynamics/systems/two_k_v/two_k_v.h"
#include "geometry/gear_pair.h"

/// A 2K-V scene as the stage of the lumped model, and what that stands on.
namespace annulus::app {

/// Sun and planet at their reference centre distance. Throws GeometryError, naming the gear, when they cannot exist or
/// mesh, and InputError when neighbouring planets touch.
[[nodiscard]] geometry::GearPair sun_planet_pair(const Scene& scene);

/// Everything that needs no solving: gears, arc teeth, the files of prescribed tables. Throws InputError.
void check_two_k_v(const Scene& scene);

/// Teeth, radii, operating point and nothing else: for speeds, forces and the ratio.
[[nodiscard]] dynamics::TwoKVStage two_k_v_kinematics(const Scene& scene);

/// The arc teeth on their pins; nothing where the scene does not give all their dimensions.
[[nodiscard]] std::optional<dynamics::ArcToothMesh> arc_tooth_mesh(const Scene& scene);

/// The scene with computed stiffness wherever it asks for a comparison; nothing when it does not.
[[nodiscard]] std::optional<Scene> compared_scene(const Scene& scene);

[[nodiscard]] MeshModel two_k_v_sun_model(const Scene& scene);
/// Of the contact formulas; `model` "line_contact" where it is computed.
[[nodiscard]] MeshModel arc_pins_model(const Scene& scene);

/// The sun mesh where its stiffness is prescribed.
[[nodiscard]] MeshResult prescribed_sun_result(const Scene& scene, const MeshModel& model);
/// The arc mesh from the contact formulas or as prescribed. Quick.
[[nodiscard]] MeshResult arc_pins_result(const Scene& scene);

/// Stiffness of both meshes.
struct TwoKVTables {
  MeshResult sun, arc;
};

/// `dependence` of meshes with tables; modes and sensitivities take the curves at the nominal load. Needs [dynamics].
[[nodiscard]] dynamics::TwoKVStage make_two_k_v(const Scene& scene, const TwoKVTables& tables,
                                                dynamics::LoadDependence dependence);
[[nodiscard]] dynamics::SimulationOptions two_k_v_simulation(const Scene& scene, const dynamics::TwoKVStage& stage);

/// A 2K-V stage as its results need it.
struct TwoKVModels {
  dynamics::TwoKVStage at_nominal;  ///< tables at the nominal load: modes and statics
  dynamics::TwoKVStage moving;
  double arc_clearance = 0;  ///< m, see dynamics::lost_motion
};
/// Needs [dynamics].
[[nodiscard]] TwoKVModels two_k_v_models(const Scene& scene, const TwoKVTables& tables);

/// Identity of everything the results depend on.
[[nodiscard]] std::string two_k_v_id(const TwoKVModels& models, const dynamics::SimulationOptions& options,
                                     const TwoKVTables& tables);

}  // namespace annulus::app
