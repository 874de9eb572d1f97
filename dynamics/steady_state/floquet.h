#pragma once

#include <Eigen/Core>

#include "dynamics/steady_state/sampled_meshes.h"

namespace annulus::dynamics {

/// Floquet multipliers of a periodic motion, largest first: factors by which disturbances grow over the period (s).
/// `meshes` were evaluated at the motion, `mesh_stiffness` (N/m, one per mesh) is any constant stiffness near it.
///
/// The motion with constant stiffness is exact. What stiffness, contact and damping differ from it acts as impulses,
/// at the samples and as often between them as the fastest mode needs, where it is interpolated. Modes that vibrate
/// more than some 600 times in the period feel the constant stiffness alone. Multipliers converge with the square of
/// the spacing of the samples. Where contact changes, the derivative of the mean force over the time step contains the
/// jump of the damping force. Rigid motions that nothing resists are left out; their multipliers are 1.
[[nodiscard]] Eigen::VectorXcd floquet_multipliers(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness,
                                                   const SampledMeshes& meshes, double period);

}  // namespace annulus::dynamics
