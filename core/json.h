#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/figure.h"

/// How the project writes JSON: members keep their order, what is not known is null.
namespace annulus {

using Json = nlohmann::ordered_json;

/// Of a file and of the standard output: indented, with a line break at its end. Text that is not UTF-8 has U+FFFD in
/// its place.
[[nodiscard]] std::string text_of(const Json& json);

/// null for NaN and infinite values, which JSON does not have.
[[nodiscard]] Json json_number(double x);
[[nodiscard]] Json json_number(const std::optional<double>& x);
/// NaN for null. Throws what the JSON library throws for anything but a number.
[[nodiscard]] double number_of(const Json& json);
/// The member of an object, or null where there is none or `json` is no object.
[[nodiscard]] const Json& member(const Json& json, const std::string& key);

/// All six parts by their names in files; null where not known.
[[nodiscard]] Json to_json(const ErrorParts& parts);
/// Throws what the JSON library throws where a part is missing.
[[nodiscard]] ErrorParts error_parts_of(const Json& json);

/// {"value": 1, "error": 0.1}.
[[nodiscard]] Json to_json(const Figure& figure);
[[nodiscard]] Json to_json(const Figure& figure, const ErrorParts& parts);  ///< with "error_parts"
[[nodiscard]] Figure figure_of(const Json& json);

/// {"quantile_05": 1, "median": 2, "quantile_95": 3, "samples": 20}.
[[nodiscard]] Json to_json(const Spread& spread);

/// {key: {"value": 1, "error": 0.1, "error_parts": {...}, "spread": {...}}}; the parts only where one is not zero, the
/// spread where there is one.
[[nodiscard]] Json to_json(const FigureSet& figures);
[[nodiscard]] FigureSet figure_set_of(const Json& json);

}  // namespace annulus
