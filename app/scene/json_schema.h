#pragma once

#include "core/json.h"

namespace annulus::app {

/// The declarations of all scene keys as a JSON Schema (draft 7), for editors that complete and check TOML files:
/// tables, types, ranges, choices, defaults, units and meanings, and what each kind of stage requires. Rules between
/// keys are in the descriptions of their keys.
[[nodiscard]] Json json_schema();

}  // namespace annulus::app
