#pragma once

#include "app/model/gear_system.h"

namespace annulus::app {

/// A pair of helical gears.
[[nodiscard]] SystemKind helical_pair_kind();

}  // namespace annulus::app
