#pragma once

#include <string>
#include <vector>

#include "app/plan/plan.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"

/// What the plan of a stage says of its bodies in three dimensions.
namespace annulus::app {

/// Whether annulus statics has to ask if bodies leave the plane.
[[nodiscard]] bool has_statics_in_space(const Scene& scene);
/// The degrees of freedom of the lumped model, without [dynamics] those of annulus statics: `plane` where the scene has
/// nothing in space.
[[nodiscard]] std::vector<DofPlan> dofs_in_space(const Scene& scene, const GearGeometry& geometry,
                                                 std::vector<DofPlan> plane);

/// Which degrees of freedom annulus statics has, and why. Empty where the scene raises no question.
[[nodiscard]] std::string remark_on_statics(const Scene& scene, const GearGeometry& geometry);

}  // namespace annulus::app
