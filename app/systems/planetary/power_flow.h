#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/systems/planetary/operating_point.h"

namespace annulus::app {

/// Which member is held and drives, and what is known of the speeds. Where the torque of the sun then is clockwise, the
/// scene becomes its mirror image (directions reversed, helix of the other hand), which is what is computed.
void check_power_flow(Scene& scene, std::vector<Problem>& problems);

/// The scene as its drawings have it: the mirror image of one that is computed as its mirror image.
[[nodiscard]] Scene as_drawn(const Scene& scene, const OperatingPoint& point);

/// What a member does: "drives", "delivers", "held", or "carries torque at rest".
[[nodiscard]] std::string role_of(const Scene& scene, const OperatingPoint& point, geometry::StageMember member);
using geometry::stage_members;

}  // namespace annulus::app
