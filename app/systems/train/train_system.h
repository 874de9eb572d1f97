#pragma once

#include "app/model/gear_system.h"

namespace annulus::app {

/// Gear sets in line on shafts: each part is a scene of its own, of any kind that has turning bodies.
[[nodiscard]] SystemKind train_kind();

}  // namespace annulus::app
