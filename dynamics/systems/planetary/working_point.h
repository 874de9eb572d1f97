#pragma once

#include "dynamics/systems/planetary/spatial_stage.h"

namespace annulus::dynamics {

/// Whether a load keeps its direction in the housing, past which the carrier turns. The dynamics has no such loads.
[[nodiscard]] bool stands_in_housing(const StageLoad& load);

/// The dynamics of a stage in space (PlanetaryStage::space), for small motions about its equilibrium at time 0:
/// bearings with clearance, rollers and tables have their tangents there and the forces they bear. Planets have their
/// centrifugal forces. Of gravity and loads that stand in the housing only the part along the axis acts, because the
/// rest turns past the carrier. All of them act where the tangents of bearings on the housing are found; these have the
/// mean over a turn, as have bearings whose stiffness depends on the direction. Where the carrier stands still
/// everything acts as it is. Planets' bearings contain their pins. Where nothing calls for it (reasons_for_space()), no
/// body moves along the axis or tilts. The faces have no width yet.
///
/// Throws what assemble() and Mechanism::solve() throw.
[[nodiscard]] StageSpace space_about_equilibrium(const SpatialStage& stage, const StageSpace::TiltInertia& inertia);

}  // namespace annulus::dynamics
