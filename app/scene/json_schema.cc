#include "app/scene/json_schema.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

namespace {

Json with_range(Json type, const Parameter& p) {
  if (std::isfinite(p.low)) type[p.low_included ? "minimum" : "exclusiveMinimum"] = p.low;
  if (std::isfinite(p.high) && !p.may_be_infinite) type["maximum"] = p.high;
  return type;
}

/// Of one value, or of a value of a list.
Json type_of(const Parameter& p) {
  switch (p.kind) {
    case Parameter::Kind::integer:
      return with_range({{"type", "integer"}}, p);
    case Parameter::Kind::real:
    case Parameter::Kind::reals: {
      Json number = with_range({{"type", "number"}}, p);
      if (p.may_be_infinite) number["type"] = {"number", "null"};  // what some editors make of inf
      if (p.words.empty()) return number;
      Json words = Json::array();
      for (const auto& [word, value] : p.words) words.push_back(word);
      return {{"anyOf", {number, {{"enum", words}}}}};
    }
    case Parameter::Kind::choice:
    case Parameter::Kind::text:
    case Parameter::Kind::texts:
      break;
  }
  return p.choices.empty() ? Json{{"type", "string"}} : Json{{"type", "string"}, {"enum", p.choices}};
}

Json key_schema(const Parameter& p) {
  Json schema = type_of(p);
  if (p.kind == Parameter::Kind::reals || p.kind == Parameter::Kind::texts) {
    schema = {{"type", "array"}, {"items", schema}, {"maxItems", p.longest}};
    if (!p.at_least_one.empty()) schema["minItems"] = 1;
    if (p.distinct) schema["uniqueItems"] = true;
  }
  std::string text = p.meaning;
  if (!p.unit.empty()) text += fmt::format("\nUnit: {}.", p.unit);
  text += fmt::format("\n{}.", expected_text(p));
  text += fmt::format("\n{}.", presence_text(p));
  for (const auto& rule : rule_texts(p)) text += fmt::format("\n{}.", rule);
  if (!p.kinds.empty()) text += fmt::format("\nFor stages of kind {}.", listed(p.kinds));
  schema["description"] = text;
  return schema;
}

Json object_schema() { return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}}; }

/// The object of a table within that of the scene; makes the tables on the way.
Json& table_at(Json& scene, const Table& table) {
  Json* object = &scene;
  std::istringstream path(table.path);
  for (std::string name; std::getline(path, name, '.');) {
    Json& properties = (*object)["properties"];
    if (!properties.contains(name)) properties[name] = object_schema();
    object = &properties[name];
  }
  if (!table.repeated) return *object;
  if (!object->contains("items")) *object = {{"type", "array"}, {"items", object_schema()}};
  return (*object)["items"];
}

/// What one kind requires: of tables that are there, and the tables themselves.
Json required_by(const std::string& kind) {
  Json root = {{"properties", Json::object()}, {"required", {"stage"}}};
  for (const auto& table : schema(kind)) {
    Json keys = Json::array();
    for (const auto& p : table.parameters)
      if (p.required(kind)) keys.push_back(p.name);
    if (keys.empty()) continue;
    if (table.path.empty()) {
      for (const auto& key : keys) root["required"].push_back(key);
      continue;
    }
    Json* object = &root;
    std::istringstream path(table.path);
    for (std::string name; std::getline(path, name, '.');) object = &(*object)["properties"][name];
    (*object)[table.repeated ? "items" : "required"] = table.repeated ? Json{{"required", keys}} : keys;
    if (table.required && table.path.find('.') == std::string::npos && table.path != "stage")
      root["required"].push_back(table.path);
  }
  const Json is_kind = {
      {"required", {"stage"}},
      {"properties", {{"stage", {{"required", {"kind"}}, {"properties", {{"kind", {{"const", kind}}}}}}}}}};
  return {{"if", is_kind}, {"then", root}};
}

}  // namespace

Json json_schema() {
  Json root = object_schema();
  root["$schema"] = "http://json-schema.org/draft-07/schema#";
  root["title"] = "Scene of annulus";
  for (const auto& table : schema()) {
    Json& object = table_at(root, table);
    if (!table.meaning.empty() && !table.path.empty()) object["description"] = table.meaning;
    for (const auto& p : table.parameters) object["properties"][p.name] = key_schema(p);
  }
  root["properties"]["assumed"] = {{"type", "object"},
                                   {"description", "Inputs that are assumed, by their keys, each with its reason."}};
  root["required"] = {"stage"};
  root["properties"]["stage"]["required"] = {"kind"};
  root["allOf"] = Json::array();
  for (const auto& kind : stage_kinds()) root["allOf"].push_back(required_by(kind));
  return root;
}

}  // namespace annulus::app
