#pragma once

#include <vector>

#include "core/figure.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Natural frequencies among the results of a planetary stage.
inline constexpr int planetary_frequencies = 6;

/// The results of the lumped model of a planetary stage, each declared once. Those of both kinds of meshes have keys
/// that begin with sun_planet_ and ring_planet_.
[[nodiscard]] const std::vector<FigureSpec>& planetary_figures();

/// Results of a response with their errors, by the keys above; of the factors and the loss of contact the
/// largest over the planets.
[[nodiscard]] FigureSet figures(const DynamicResponse& response);

}  // namespace annulus::dynamics
