#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <string>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// A value as messages show it.
[[nodiscard]] std::string node_text(const toml::node& node);
/// What is wrong with a text, empty if nothing is. Texts go into reports, tables and messages.
[[nodiscard]] std::string text_rule(const std::string& text);
/// Takes `value` from `node`; what is wrong with it, empty if nothing is.
[[nodiscard]] std::string read_value(const Parameter& parameter, const toml::node& node, Value& value);

/// The tables of a text. Throws SceneError, with the place in `file`, when it is not TOML or larger than any scene.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& file);
/// The text of a file, at most one byte more than a scene may have. Throws InputError when it cannot be read.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file);

/// The scene that the tables of `file` make; with `tables`, a file of these and not of the schema, whose values go
/// where they say. Throws SceneError with every problem found.
[[nodiscard]] Scene read_tables(const toml::table& root, const std::filesystem::path& file,
                                const std::vector<Table>* tables = nullptr);

}  // namespace annulus::app
