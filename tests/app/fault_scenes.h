#pragma once

#include <string>

#include "core/files.h"

namespace annulus::test {

/// A scene that once showed a fault: the file, and its text.
inline std::string fault_scene_file(const std::string& name) {
  return ANNULUS_SOURCE_DIR "/tests/app/fault_scenes/" + name + ".toml";
}
inline std::string fault_scene(const std::string& name) { return read_file(fault_scene_file(name)); }

}  // namespace annulus::test
