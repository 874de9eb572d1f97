#pragma once

#include "core/figure.h"

namespace annulus::dynamics {

/// "steady": whether a periodic steady state was found; a result of every lumped model.
[[nodiscard]] FigureSpec steady_figure();

}  // namespace annulus::dynamics
