#pragma once

#include <vector>

#include "core/figure.h"
#include "dynamics/systems/planetary/study_point.h"

namespace annulus::dynamics {

/// The results of the lumped model of a planetary stage, each declared once. Those of both kinds of meshes have keys
/// that begin with sun_planet_ and ring_planet_.
[[nodiscard]] const std::vector<FigureSpec>& planetary_figures();

/// Results of a response with their errors, by the keys above; of the dynamic factor and the loss of contact the
/// largest over the planets.
[[nodiscard]] FigureSet figures(const DynamicResponse& response);
/// Results of a study's response: those of effort `forces`, and those of effort `motion`.
[[nodiscard]] FigureSet figures(const PointFigures& point);
[[nodiscard]] FigureSet motion_figures(const PointFigures& point);

}  // namespace annulus::dynamics
