#pragma once

#include <functional>
#include <string>

#include "app/scene/scene.h"

namespace annulus::app {

/// "scene.toml:12:1: sun: ..." for what is wrong with a scene as a whole: the place of the key, ring or table with
/// whose name the message starts, else that of the stage.
[[nodiscard]] std::string with_place(const Scene& scene, const std::string& message);

/// The place of one input: "scene.toml:12:1"; without line when the scene does not give it.
[[nodiscard]] std::string place_text(const Scene& scene, const std::string& key, std::size_t entry = 0);

/// Calls `action`. An InputError of it without a place gets the name of what it is about in front ("bearing"), and its
/// place.
void about(const Scene& scene, const std::string& name, const std::function<void()>& action);

/// The message without a place in this scene's file in front.
[[nodiscard]] std::string without_place(const Scene& scene, const std::string& message);

}  // namespace annulus::app
