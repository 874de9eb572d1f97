#include "app/scene/example_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "app/scene/scene_value.h"
#include "core/errors.h"

namespace annulus::app {

const std::string& example_scene(const std::string& name) {
  const auto& all = example_scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& example) { return example.name == name; });
  if (found != all.end()) return found->text;
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const auto& example : all) names.push_back(example.name);
  const std::string near = nearest(name, names);
  throw InputError(fmt::format("{}: there is no such example{}; the examples are {}", name,
                               near.empty() ? "" : ", did you mean " + near + "?", fmt::join(names, ", ")));
}

std::string example_to_start_from(const std::string& name) {
  static const std::regex published("(^|\n)(reference *=)");
  return std::regex_replace(example_scene(name), published, "$1# $2");
}

}  // namespace annulus::app
