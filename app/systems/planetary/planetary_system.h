#pragma once

#include "app/model/gear_system.h"

namespace annulus::app {

/// A planetary stage with its rings.
[[nodiscard]] SystemKind planetary_kind();

}  // namespace annulus::app
