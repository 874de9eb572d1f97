#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/spatial/linear_supports.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Gives a bearing its whole law, `bearing`, if that bends: forces that its stiffness leaves to it become zero. `axes`:
/// LinearBearing::law_axes.
void act_by_law(LinearBearing& linear, const StageBearing& bearing, double axes = 0);

/// Adds the forces of a bearing's law beyond those of its stiffness, as meshes with names that begin with that of its
/// element; nothing for a bearing without law. `motion`: its coordinates in its place. `length`: m, by which tilts are
/// deflections of meshes.
void add_bearing_law(LumpedSystemBuilder& builder, const LinearBearing& bearing, const std::vector<LinearForm>& motion,
                     double length);

/// Force on the body beyond -(K d + f), N and N m, 5 x times. `motion`: d, m and rad, 5 x times.
[[nodiscard]] Eigen::MatrixXd beyond_stiffness(const LinearBearing& bearing, const Eigen::MatrixXd& motion);

}  // namespace annulus::dynamics
