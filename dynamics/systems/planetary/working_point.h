#pragma once

#include "dynamics/systems/planetary/spatial_stage.h"

namespace annulus::dynamics {

/// The dynamics of a stage in space (PlanetaryStage::space), for small motions about its equilibrium at time 0:
/// bearings with clearance, rollers and tables have their tangents there and the forces they bear. Planets have their
/// centrifugal forces. Gravity and loads that stand in the housing turn past the carrier (standing_loads). Bearings in
/// the housing have their tangents under all of them, those of planets under their part along the axis. Tangents in the
/// housing are the mean over a turn, where they depend on the direction. Planets' bearings contain their pins. Where
/// nothing calls for it (reasons_for_space()), no body moves along the axis or tilts. The faces have no width yet.
///
/// Throws what assemble() and Mechanism::solve() throw.
[[nodiscard]] StageSpace space_about_equilibrium(const SpatialStage& stage, const StageSpace::TiltInertia& inertia);

}  // namespace annulus::dynamics
