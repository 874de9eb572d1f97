#include "app/scene/inputs_json.h"
#include "core/json.h"

#include <cmath>

namespace annulus::app {

namespace {

Json value_json(const Value& value) {
  if (const auto* v = std::get_if<double>(&value); v && std::isinf(*v)) return "inf";
  const auto json = [](const auto& v) -> Json {
    if constexpr (std::is_same_v<decltype(v), const std::monostate&>)
      return nullptr;
    else
      return v;
  };
  return std::visit(json, value);
}

}  // namespace

Json inputs_json(const std::vector<Input>& inputs) {
  auto list = Json::array();
  for (const auto& input : inputs) {
    Json item = {{"key", input.key},
                 {"value", value_json(input.value)},
                 {"unit", input.unit},
                 {"origin", to_text(input.origin)}};
    if (!input.variant.empty()) item[input.key.substr(0, input.key.find('.'))] = input.variant;
    if (!input.assumed.empty()) item["assumed"] = input.assumed;
    if (!input.note.empty() && input.origin != Origin::scene) item["note"] = input.note;
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace annulus::app
