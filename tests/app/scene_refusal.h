#pragma once

#include <string>

#include "app/scene/scene.h"
#include "core/errors.h"

namespace annulus::test {

/// The message with which a scene is refused; empty when it is read.
inline std::string scene_refusal(const std::string& text) {
  try {
    (void)app::parse_scene(text, "scene.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace annulus::test
