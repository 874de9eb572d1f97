#pragma once

#include "dynamics/systems/planetary/spatial_stage.h"

namespace annulus::dynamics {

/// Whether a load keeps its direction in the housing, past which the carrier turns. The dynamics has no such loads.
[[nodiscard]] bool stands_in_housing(const StageLoad& load);

/// What the dynamics of a stage in space needs (PlanetaryStage::space), for small motions about its equilibrium at time
/// 0 under all loads but gravity and those that stand in the housing: bearings with clearance, rollers and tables have
/// their tangents there and the forces they bear. Bearings in the housing whose stiffness depends on the direction have
/// the mean over a turn. Planets' bearings contain their pins. The faces have no width yet.
///
/// Throws what assemble() and Mechanism::solve() throw.
[[nodiscard]] StageSpace space_about_equilibrium(const SpatialStage& stage, const StageSpace::TiltInertia& inertia);

}  // namespace annulus::dynamics
