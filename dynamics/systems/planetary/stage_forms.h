#pragma once

#include <vector>

#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// Coordinates of a body as forms of DOFs; empty ones stay 0. Displacements and u in m, tilts in rad; those of a planet
/// are radial and tangential.
struct BodyForms {
  LinearForm x, y, u, z, tilt_x, tilt_y;
};

/// The bodies of a stage as DOFs with their masses, supports and loads.
struct StageForms {
  BodyForms sun, ring, carrier;
  std::vector<BodyForms> planets;
};

/// Bodies that move along the axis and tilt. DOFs in the order sun, ring, carrier, planet1 ...: x, y, z, tiltx, tilty
/// (radius x tilt, m) as far as no bearing holds them rigidly, and u. A spring carries the name of its body and its
/// bearing. Throws InputError for bearings that stand rigidly on a body other than the housing, planets' on the
/// carrier.
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
