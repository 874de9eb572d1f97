#pragma once

#include "app/model/gear_system.h"

namespace annulus::app {

/// A 2K-V reducer.
[[nodiscard]] SystemKind two_k_v_kind();

}  // namespace annulus::app
