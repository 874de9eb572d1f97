#pragma once

#include <map>
#include <string>

#include "app/scene/scene.h"

namespace annulus::app {

/// A value of a scene yet to be written: as it stands in the file, and what is to be said about it.
struct NewValue {
  std::string text;
  std::string remark{};
};
/// By key path: "stage.module_mm". Rings and other repeated tables have one entry.
using NewValues = std::map<std::string, NewValue>;

/// As it stands in a scene file: 3.8, "pinned", [15, 36].
[[nodiscard]] std::string toml_text(const Value& value);

/// The values of an example of that kind of stage, which come with the program.
[[nodiscard]] NewValues example_values(const std::string& kind);

/// A whole scene file: every key of that kind of stage with its meaning, unit, range and default. Keys with a value
/// have it, required ones without one are left to be filled in, the others stand behind '#'.
[[nodiscard]] std::string new_scene(const std::string& kind, const NewValues& values);

}  // namespace annulus::app
