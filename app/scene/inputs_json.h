#pragma once

#include <string>
#include <vector>

#include "app/scene/scene_value.h"
#include "core/json.h"

namespace annulus::app {

/// Inputs with their origin as a JSON array: key, value, unit, origin; the variant (under the name of its table),
/// assumed and note where there are any. Values are in the unit of their key, "inf" where one is infinite.
[[nodiscard]] Json inputs_json(const std::vector<Input>& inputs);

}  // namespace annulus::app
