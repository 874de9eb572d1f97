#include "app/model/error_parts_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace annulus::app {

std::string error_parts_json(const ErrorParts& parts) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : error_part_names)
    json[name] = std::isfinite(parts.*part) ? nlohmann::ordered_json(parts.*part) : nlohmann::ordered_json(nullptr);
  return json.dump();
}

ErrorParts parse_error_parts(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  ErrorParts parts;
  for (const auto& [name, part] : error_part_names) {
    const auto& value = json.at(name);
    parts.*part = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  return parts;
}

}  // namespace annulus::app
