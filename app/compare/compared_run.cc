#include "app/compare/compared_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include "app/model/gear_system.h"
#include "app/run/finished_run.h"
#include "app/scene/scene_schema.h"
#include "app/scene/scene_value.h"
#include "core/errors.h"
#include "core/json.h"

namespace annulus::app {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_summary = 50'000'000;  // bytes; those of long searches have a few millions

constexpr const char *give_a_run = "give a folder that 'annulus run SCENE -o OUT' wrote",
                     *give_one = "give one that 'annulus run SCENE -o OUT' wrote";

/// Whether something of a run lies here: results of meshes, or a cache.
bool has_begun(const fs::path& folder) {
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const auto name = at->path().filename().string();
    if (name == "cache" || name == "run.json" || name == "dynamics" || name.starts_with("stiffness_") ||
        name.starts_with("lte_"))
      return true;
  }
  return false;
}

Json read_summary(const fs::path& folder) {
  const auto file = folder / "summary.json";
  std::error_code error;
  const auto refuse = [&](const char* why, const char* remedy) {
    throw InputError(fmt::format("{}: {}; {}", folder.string(), why, remedy));
  };
  if (!fs::exists(folder, error)) refuse("there is no such folder", give_one);
  if (!fs::is_directory(folder, error)) refuse("is not a folder", give_one);
  const auto unfinished = [&](const std::string& why) {
    return InputError(fmt::format(
        "{0}: its run is not finished ({1}); continue it with 'annulus run SCENE -o {0}' and its scene, then compare",
        folder.string(), why));
  };
  if (!fs::exists(file, error)) {
    if (has_begun(folder)) throw unfinished("no summary.json");
    refuse("contains no run (no summary.json)", give_a_run);
  }
  if (fs::file_size(file, error) > largest_summary || error)
    throw InputError(fmt::format("{}: cannot be read or is larger than {} bytes; run its scene again", file.string(),
                                 largest_summary));
  std::ifstream stream(file);
  Json summary;
  try {
    summary = Json::parse(stream);
  } catch (const Json::exception& what) {
    throw InputError(fmt::format("{}: is damaged: {}; run its scene again", file.string(), what.what()));
  }
  if (const auto why = why_unfinished(folder)) throw unfinished(*why);
  return summary;
}

std::string input_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number() ? to_text(value.get<double>()) : value.dump();
}

/// Inputs of one variant: its own and those of all.
std::map<std::string, std::string> inputs_of(const Json& json, const std::string& variant) {
  std::map<std::string, std::string> inputs;
  for (const auto& input : json.at("inputs")) {
    const std::string key = input.at("key"), own = input.value(key.substr(0, key.find('.')), "");
    if (key == "title" || (!own.empty() && own != variant)) continue;
    const auto& value = input.at("value");
    auto& text = inputs[key];
    // Tables of a list (sweeps, random inputs) have the same keys.
    text += (text.empty() ? "" : "; ") + input_text(value);
  }
  return inputs;
}

ComparedRun run_of(const Json& json, const fs::path& folder) {
  ComparedRun run{.folder = folder,
                  .title = json.at("title"),
                  .version = json.at("annulus_version"),
                  .kind = json.at("kind"),
                  .accuracy = json.at("accuracy_wanted")};
  for (const auto& kind : system_kinds())
    if (run.kind == kind.scene.name) run.specs = &kind.figures();
  if (!run.specs) throw InputError(fmt::format("kind is '{}'; the kinds are {}", run.kind, listed(stage_kinds())));
  for (const auto& variant : json.at("variants")) {
    const std::string name = variant.at("name");
    run.variants.push_back(
        {.name = name, .figures = figure_set_of(variant.at("figures")), .inputs = inputs_of(json, name)});
  }
  if (run.variants.empty()) throw InputError("it has no variants");
  bool has_results = false;
  for (const auto& variant : run.variants)
    for (const auto& entry : variant.figures.entries()) has_results |= std::isfinite(entry.figure.value);
  if (!has_results) throw InputError("it contains no results");
  for (const auto& [stage, seconds] : json.at("timings_s").items()) run.timings.emplace_back(stage, seconds);
  run.peak_memory_MB = json.at("peak_memory_MB");
  if (json.contains("reuse")) run.read_back = json.at("reuse").at("reused").size();
  return run;
}

ComparedRun read_run(const fs::path& folder) {
  const auto json = read_summary(folder);
  try {
    return run_of(json, folder);
  } catch (const std::exception& what) {  // of the JSON library, or InputError
    throw InputError(fmt::format("{}: is not a summary of annulus: {}; {}", (folder / "summary.json").string(),
                                 what.what(), give_a_run));
  }
}

/// The folder with so many of its parents.
std::string last_parts(const fs::path& folder, std::size_t parts) {
  fs::path name;
  auto at = folder.end();
  while (parts-- > 0 && at != folder.begin()) name = name.empty() ? fs::path(*--at) : fs::path(*--at) / name;
  return name.generic_string();
}

/// As few parents as make the names differ.
void name_runs(std::vector<ComparedRun>& runs, const std::vector<fs::path>& places) {
  constexpr std::size_t deepest = 64;
  for (std::size_t parts = 1; parts < deepest; ++parts) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < runs.size(); ++i) names.push_back(runs[i].name = last_parts(places[i], parts));
    std::sort(names.begin(), names.end());
    if (std::adjacent_find(names.begin(), names.end()) == names.end()) break;
  }
  for (auto& run : runs)
    for (auto& variant : run.variants)
      variant.name = run.variants.size() == 1 || variant.name.empty() ? run.name : run.name + ": " + variant.name;
}

}  // namespace

std::vector<ComparedRun> read_finished_runs(const std::vector<std::string>& folders) {
  if (folders.size() < 2)
    throw InputError(fmt::format("compare{}: needs the folders of two finished runs or more",
                                 folders.empty() ? "" : " " + folders.front()));
  std::vector<fs::path> places;
  for (const auto& folder : folders) {
    auto place = fs::weakly_canonical(fs::absolute(folder));
    if (!place.has_filename()) place = place.parent_path();
    if (std::find(places.begin(), places.end(), place) != places.end())
      throw InputError(folder + ": is given twice; give every folder once");
    places.push_back(std::move(place));
  }
  std::vector<ComparedRun> runs;
  for (const auto& folder : folders) {
    runs.push_back(read_run(folder));
    if (runs.back().kind != runs.front().kind)
      throw InputError(fmt::format(
          "{}: is a stage of kind {}, {} one of kind {}: they have no common results; compare stages of one kind",
          folder, runs.back().kind, folders.front(), runs.front().kind));
  }
  name_runs(runs, places);
  return runs;
}

}  // namespace annulus::app
