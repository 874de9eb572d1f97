#pragma once

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error_parts.h"

namespace annulus::app {

/// All six parts by their names in files; null where not known.
inline nlohmann::ordered_json error_parts_json(const ErrorParts& parts) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : error_part_names)
    json[name] = std::isfinite(parts.*part) ? nlohmann::ordered_json(parts.*part) : nlohmann::ordered_json(nullptr);
  return json;
}
inline ErrorParts error_parts_of(const nlohmann::ordered_json& json) {
  ErrorParts parts;
  for (const auto& [name, part] : error_part_names) {
    const auto& value = json.at(name);
    parts.*part = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  return parts;
}

}  // namespace annulus::app
