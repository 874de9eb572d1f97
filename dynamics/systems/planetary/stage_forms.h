#pragma once

#include <vector>

#include "dynamics/spatial/space_bodies.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// The bodies of a stage as DOFs with their masses, supports and loads.
struct StageForms {
  BodyForms sun, ring, carrier;
  std::vector<BodyForms> planets;
};

/// Bodies that move along the axis and tilt (add_space_bodies()), in the order sun, ring, carrier, planet1 ...
[[nodiscard]] StageForms add_bodies_in_space(LumpedSystemBuilder& builder, const PlanetaryStage& stage);

/// The 5 coordinates of a LinearBearing between a body and what it stands on, in the body's middle. `bodies`: of the
/// stage.
[[nodiscard]] std::vector<LinearForm> relative_motion(const PlanetaryStage& stage, const StageForms& bodies,
                                                      const StageBody& body, const StageBody& on);

/// Those of a bearing, in its place.
[[nodiscard]] std::vector<LinearForm> bearing_motion(const PlanetaryStage& stage, const StageForms& bodies,
                                                     const LinearBearing& bearing);

/// A mesh of a stage in space beside that of the plane: what motions out of the plane add to the approach in the middle
/// of the face, and the approach by which its end exceeds its middle.
struct MeshOutOfPlane {
  LinearForm approach, tilt;
};
enum class MeshWith { sun, ring };
[[nodiscard]] MeshOutOfPlane mesh_out_of_plane(const PlanetaryStage& stage, const StageForms& bodies, MeshWith wheel,
                                               int planet);

}  // namespace annulus::dynamics
