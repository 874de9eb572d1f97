#include "app/scene/inputs_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace annulus::app {

namespace {

using InputJson = nlohmann::ordered_json;

InputJson value_json(const Value& value) {
  if (const auto* v = std::get_if<long>(&value)) return *v;
  if (const auto* v = std::get_if<double>(&value)) return std::isinf(*v) ? InputJson("inf") : InputJson(*v);
  if (const auto* v = std::get_if<std::string>(&value)) return *v;
  if (const auto* v = std::get_if<std::vector<double>>(&value)) return *v;
  if (const auto* v = std::get_if<std::vector<std::string>>(&value)) return *v;
  return nullptr;
}

}  // namespace

std::string inputs_json(const std::vector<Input>& inputs) {
  auto list = InputJson::array();
  for (const auto& input : inputs) {
    InputJson item = {{"key", input.key},
                      {"value", value_json(input.value)},
                      {"unit", input.unit},
                      {"origin", to_text(input.origin)}};
    if (!input.ring.empty()) item["ring"] = input.ring;
    if (!input.assumed.empty()) item["assumed"] = input.assumed;
    if (!input.note.empty() && input.origin != Origin::scene) item["note"] = input.note;
    list.push_back(std::move(item));
  }
  return list.dump();
}

}  // namespace annulus::app
