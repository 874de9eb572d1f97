#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "core/stiffness_table.h"

namespace annulus::app {

/// The file that a scene names under `key` (mesh.sun_planet.file, reference). A scene reads below its own folder only:
/// throws InputError for absolute paths, for those that lead elsewhere, links followed, and for what is no file.
[[nodiscard]] std::filesystem::path file_of_scene(const Scene& scene, const std::string& key, const std::string& name);

/// The same; errors give the reason alone, without place and key.
[[nodiscard]] std::filesystem::path file_below_scene(const Scene& scene, const std::string& name);

/// The files that inputs name, but for the reference: tables (mesh.NAME.file), measured flanks, scenes of parts and the
/// files that those name; relative to the scene.
[[nodiscard]] std::vector<std::string> input_files(const Scene& scene);

/// The stiffness table in the file that [mesh.NAME] names. Throws InputError, with place and key, when it cannot be
/// used.
[[nodiscard]] StiffnessTable prescribed_table(const Scene& scene, const std::string& mesh, const std::string& name);

/// Reads every file the scene names, so that a bad one is refused before time is spent. Throws InputError.
void check_files(const Scene& scene);

}  // namespace annulus::app
