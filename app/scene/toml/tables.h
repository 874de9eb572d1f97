#pragma once

#include "app/scene/scene.h"
#include "app/scene/toml/values.h"

namespace annulus::app {

/// The scene that the tables of `file` make. Throws SceneError with every problem found.
[[nodiscard]] Scene read_tables(const toml::table& root, const std::filesystem::path& file);

}  // namespace annulus::app
