#include "app/scene/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/scene/input_place.h"
#include "app/scene/reference.h"
#include "app/scene/scene_limits.h"
#include "core/table_import.h"

namespace annulus::app {

namespace {

constexpr std::uintmax_t largest_file = 100'000'000;  // bytes; a table of 1000 positions, 64 phases, 9 loads has 60 MB

InputError refusal(const Scene& scene, const std::string& key, const std::string& name, const std::string& why) {
  return InputError(
      fmt::format("{}: {} = \"{}\": {}", place_text(scene, key), key, shown(name), without_controls(why)));
}

/// Applies `use` to the file; what is wrong with its content is reported with the key that names it.
template <class Use>
auto with_file(const Scene& scene, const std::string& key, const std::string& name, Use use) {
  const auto file = file_of_scene(scene, key, name);
  try {
    return use(file);
  } catch (const InputError& error) {
    throw refusal(scene, key, name, error.what());
  }
}

}  // namespace

std::filesystem::path file_below_scene(const Scene& scene, const std::string& name) {
  namespace fs = std::filesystem;
  constexpr const char* where = "a path relative to the scene, to a file in its folder or below";
  if (name.empty() || fs::path(name).is_absolute()) throw InputError(fmt::format("must be {}", where));
  std::error_code error;
  const auto folder = scene.file.parent_path();
  auto file = folder / name;
  // Made absolute first: of a file that is not there, a relative path would stay one.
  const auto root = fs::weakly_canonical(fs::absolute(folder.empty() ? fs::path(".") : folder), error);
  const auto target = error ? fs::path() : fs::weakly_canonical(fs::absolute(file), error);
  const bool below =
      !error && std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first == root.end();
  if (!below) throw InputError(fmt::format("leads out of the scene's folder; must be {}", where));
  const auto status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError("there is no such file; is the path right?");
  if (!fs::is_regular_file(status)) throw InputError("is not a file");
  if (const auto size = fs::file_size(file, error); error || size > largest_file)
    throw InputError(fmt::format("is larger than {} MB", largest_file / 1'000'000));
  return file;
}

std::filesystem::path file_of_scene(const Scene& scene, const std::string& key, const std::string& name) {
  try {
    return file_below_scene(scene, name);
  } catch (const InputError& error) {
    throw refusal(scene, key, name, error.what());
  }
}

std::vector<std::string> input_files(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& input : scene.inputs)
    if (const auto* name = std::get_if<std::string>(&input.value);
        name != nullptr &&
        (input.key.ends_with(".file") || input.key.ends_with("_file") || input.key.ends_with("_topography")))
      names.push_back(*name);
  names.insert(names.end(), scene.further_files.begin(), scene.further_files.end());
  return names;
}

StiffnessTable prescribed_table(const Scene& scene, const std::string& mesh, const std::string& name) {
  return with_file(scene, "mesh." + mesh + ".file", name,
                   [&](const std::filesystem::path& file) { return import_table(file, mesh); });
}

void check_files(const Scene& scene) {
  const std::string head = "mesh.", tail = ".file";
  for (const auto& input : scene.inputs) {
    const auto* name = std::get_if<std::string>(&input.value);
    if (name == nullptr || !input.key.starts_with(head) || !input.key.ends_with(tail)) continue;
    (void)prescribed_table(scene, input.key.substr(head.size(), input.key.size() - head.size() - tail.size()), *name);
  }
  if (scene.reference)
    with_file(scene, "reference", *scene.reference, [](const auto& file) { return read_reference(file); });
}

}  // namespace annulus::app
