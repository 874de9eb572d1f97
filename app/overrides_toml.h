#pragma once

#include <toml++/toml.h>

#include "app/overrides.h"

namespace annulus::app {

/// Sets the values in the parsed file of `scene`.
void apply_overrides(toml::table& root, const Scene& scene, const std::vector<Override>& overrides);

}  // namespace annulus::app
