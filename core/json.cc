#include "core/json.h"

#include <algorithm>
#include <cmath>

namespace annulus {

std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json json_number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json json_number(const std::optional<double>& x) { return x ? json_number(*x) : Json(nullptr); }

double number_of(const Json& json) { return json.is_null() ? not_known : json.get<double>(); }

const Json& member(const Json& json, const std::string& key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto found = json.find(key);
  return found == json.end() ? none : *found;
}

Json to_json(const ErrorParts& parts) {
  Json json;
  for (const auto& [name, part] : error_part_names) json[name] = json_number(parts.*part);
  return json;
}

ErrorParts error_parts_of(const Json& json) {
  ErrorParts parts;
  for (const auto& [name, part] : error_part_names) parts.*part = number_of(json.at(name));
  return parts;
}

Json to_json(const Figure& figure) {
  return {{"value", json_number(figure.value)}, {"error", json_number(figure.error)}};
}

Json to_json(const Figure& figure, const ErrorParts& parts) {
  auto json = to_json(figure);
  json["error_parts"] = to_json(parts);
  return json;
}

Figure figure_of(const Json& json) { return {number_of(json.at("value")), number_of(json.at("error"))}; }

Json to_json(const Spread& spread) {
  return {{"quantile_05", json_number(spread.low)},
          {"median", json_number(spread.median)},
          {"quantile_95", json_number(spread.high)},
          {"samples", spread.samples}};
}

Json to_json(const FigureSet& figures) {
  Json json = Json::object();
  for (const auto& entry : figures.entries()) {
    auto& item = json[entry.key] = to_json(entry.figure);
    const auto& parts = entry.parts;
    const bool known = std::any_of(error_part_names.begin(), error_part_names.end(),
                                   [&](const auto& name) { return parts.*name.second != 0; });
    if (known) item["error_parts"] = to_json(parts);
    if (entry.spread) item["spread"] = to_json(*entry.spread);
  }
  return json;
}

FigureSet figure_set_of(const Json& json) {
  FigureSet figures;
  for (const auto& [key, item] : json.items()) {
    const auto& parts = member(item, "error_parts");
    figures.set(key, figure_of(item), parts.is_null() ? ErrorParts{} : error_parts_of(parts));
    if (const auto& s = member(item, "spread"); !s.is_null())
      figures.set_spread(key, {number_of(s.at("quantile_05")), number_of(s.at("median")),
                               number_of(s.at("quantile_95")), s.at("samples").get<int>()});
  }
  return figures;
}

}  // namespace annulus
