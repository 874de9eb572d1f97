#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/spatial/linear_supports.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Gives a bearing its whole law where `bearing` is nonlinear. `axes`: LinearBearing::law_axes.
void give_law(LinearBearing& linear, const StageBearing& bearing, double axes = 0);
/// A bearing with f = 0 in the coordinates whose forces a law contains: its own, or that of its coupling.
[[nodiscard]] LinearBearing beside_law(const SpaceSupports& supports, std::size_t bearing);

/// Adds the forces of a bearing's law beyond those of its stiffness, as meshes with names that begin with that of its
/// element; nothing for a bearing without law. `motion`: its coordinates in its place. `length`: m, by which tilts are
/// deflections of meshes.
void add_bearing_law(LumpedSystemBuilder& builder, const LinearBearing& bearing, const std::vector<LinearForm>& motion,
                     double length);

/// The same of a coupling. `motion`: all its coordinates.
void add_coupling_law(LumpedSystemBuilder& builder, const LinearCoupling& coupling, const SpaceSupports& supports,
                      const std::vector<LinearForm>& motion, double length);

/// Force on the body beyond -(K d + f), N and N m, 5 x times. `motion`: d, m and rad, 5 x times.
[[nodiscard]] Eigen::MatrixXd beyond_stiffness(const LinearBearing& bearing, const Eigen::MatrixXd& motion);
/// Forces (N, N m) by the law of a coupling, on its bodies: coordinates x times, as `motion` (m, rad).
[[nodiscard]] Eigen::MatrixXd forces_by_law(const LinearCoupling& coupling, const Eigen::MatrixXd& motion);

}  // namespace annulus::dynamics
