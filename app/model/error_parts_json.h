#pragma once

#include <string>

#include "core/error_parts.h"

namespace annulus::app {

/// All six parts by their names in files, as a JSON object; null where not known.
[[nodiscard]] std::string error_parts_json(const ErrorParts& parts);
/// Throws what the JSON library throws for anything else.
[[nodiscard]] ErrorParts parse_error_parts(const std::string& json);

}  // namespace annulus::app
