#pragma once

#include <string>
#include <vector>

namespace annulus::app {

/// A scene of data/scenes ("helical_set") or data/cases ("grc_750kw/planetary_stage", or "rexs_fva" of a case with one
/// scene) as it was when the program was built.
struct ExampleScene {
  std::string name, text;
};
[[nodiscard]] const std::vector<ExampleScene>& example_scenes();

/// The text of one. Throws InputError with the names for another name.
[[nodiscard]] const std::string& example_scene(const std::string& name);
/// The same to start a scene with: files that only the project has are left out.
[[nodiscard]] std::string example_to_start_from(const std::string& name);

}  // namespace annulus::app
