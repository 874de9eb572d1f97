#pragma once

#include "geometry/gear_pair.h"

namespace annulus::fem {

/// The ring mesh is solved in a mirror image of the real one, which turns the hands of helical gears and swaps the
/// flanks.
[[nodiscard]] geometry::GearPair solved_pair(const geometry::GearPair& pair);

}  // namespace annulus::fem
