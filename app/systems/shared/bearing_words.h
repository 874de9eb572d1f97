#pragma once

#include <string>
#include <vector>

#include "app/plan/plan.h"
#include "app/plan/warning.h"
#include "app/systems/shared/space_input.h"

/// What plans and warnings say of bearings in space.
namespace annulus::app {

/// Degrees of freedom of a body called `name` in its bearings: "sun x, y", "sun z", "sun tilts".
[[nodiscard]] DofPlan radial_dof(const std::string& name, const std::vector<dynamics::StageBearing>& bearings);
[[nodiscard]] DofPlan axial_dof(const std::string& name, const std::vector<dynamics::StageBearing>& bearings);
[[nodiscard]] DofPlan tilt_dof(const std::string& name, const std::vector<dynamics::StageBearing>& bearings);
[[nodiscard]] DofPlan no_dof_out_of_plane(const std::string& name);

/// `keys`: those that the scene does not mention.
[[nodiscard]] Warning tilt_inertia_assumed(const std::vector<std::string>& keys);

}  // namespace annulus::app
