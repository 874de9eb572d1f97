#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/profile.h"

namespace annulus::geometry {

/// Outline of tooth 0 in the gear's own frame, counter-clockwise from the middle of the tooth space before it to the
/// middle of the space after it: root, fillet, flank, tip (with its chamfers, at 45 degrees), flank, fillet, root,
/// without modifications. A polyline with
/// its corners on the exact curves; no chord departs from its curve by more than about `tolerance`, m. Outlines of
/// neighbouring teeth, a pitch angle further on, share their end points.
[[nodiscard]] std::vector<Eigen::Vector2d> tooth_outline(const ToothProfile& profile, double tolerance);

}  // namespace annulus::geometry
