#pragma once

#include <toml++/toml.h>
#include <string>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// In the text of a scene, from 1.
struct Place {
  int line = 0, column = 0;
};
[[nodiscard]] Place place_of(const toml::source_region& source);

/// A value as messages show it.
[[nodiscard]] std::string node_text(const toml::node& node);
/// What a key takes: type, range and unit.
[[nodiscard]] std::string expected_text(const Parameter& parameter);
/// What is wrong with a text, empty if nothing is. Texts go into reports, tables and messages.
[[nodiscard]] std::string text_rule(const std::string& text);
/// Takes `value` from `node`; what is wrong with it, empty if nothing is.
[[nodiscard]] std::string read_value(const Parameter& parameter, const toml::node& node, Value& value);

}  // namespace annulus::app
