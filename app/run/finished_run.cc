#include "app/run/finished_run.h"

#include <fmt/format.h>

#include <fstream>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/results/program_identity.h"
#include "app/scene/scene.h"
#include "app/scene/scene_files.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr const char* note_name = "run.json";
constexpr const char* missing = "missing";

/// "missing" where there is no such file.
std::string stamp(const std::filesystem::path& file) { return file_checksum(file).value_or(missing); }

}  // namespace

std::string run_id(const Scene& scene, const RunOptions& options) {
  ContentId id;
  id.add("program", program_identity());
  id.add("scene", scene.text).add("dynamics", options.with_dynamics).add("accuracy", scene.accuracy);
  for (const auto& input : scene.inputs)
    id.add(input.variant + input.key,
           fmt::format("{} {} {} {}", to_text(input.value), to_text(input.origin), input.note, input.assumed));
  auto files = input_files(scene);
  if (scene.reference) files.push_back(*scene.reference);
  for (const auto& name : files) id.add(name, stamp(scene.file.parent_path() / name));
  return id.id();
}

void keep_finished_run(const std::filesystem::path& out, const std::string& id, const std::string& text,
                       const std::vector<std::string>& files) {
  Json note = {{"annulus_version", version()}, {"inputs_id", id}, {"text", text}};
  note["files"] = Json::object();
  for (const auto& file : files) note["files"][file] = stamp(out / file);
  write_file(out / note_name, note.dump(1) + "\n");
}

std::optional<std::string> why_unfinished(const std::filesystem::path& out) {
  std::ifstream stream(out / note_name);
  if (!stream) return fmt::format("no {}", note_name);
  const auto note = Json::parse(stream, nullptr, false);
  try {
    if (note.is_discarded()) return fmt::format("{} is damaged", note_name);
    for (const auto& [name, kept] : note.at("files").items()) {
      const auto now = stamp(out / name);
      if (now != missing && now != kept) return name + " has changed since";
    }
  } catch (const Json::exception&) {
    return fmt::format("{} is damaged", note_name);
  }
  return std::nullopt;
}

void refuse_altered_result(const std::filesystem::path& file) {
  const auto whole = std::filesystem::absolute(file).lexically_normal();
  constexpr int deepest = 8;  // folders below OUT
  auto out = whole.parent_path();
  for (int i = 0; i < deepest && !std::filesystem::exists(out / note_name); ++i) out = out.parent_path();
  std::ifstream stream(out / note_name);
  const auto note = Json::parse(stream, nullptr, false);
  const auto name = whole.lexically_relative(out).generic_string();
  if (!stream || !note.is_object() || !note.contains("files") || !note["files"].contains(name)) return;
  if (note["files"][name] != stamp(whole))
    throw InputError(
        fmt::format("{}: has changed since the run that wrote it; run the scene again to restore it, or copy it to "
                    "another folder to use it as a file of your own",
                    file.string()));
}

std::optional<std::string> finished_run(const std::filesystem::path& out, const std::string& id) {
  std::ifstream stream(out / note_name);
  if (!stream) return std::nullopt;
  const auto note = Json::parse(stream, nullptr, false);
  try {
    if (note.is_discarded() || note.at("inputs_id") != id) return std::nullopt;
    for (const auto& [name, kept] : note.at("files").items()) {
      const auto now = stamp(out / name);
      if (now == kept) continue;
      log::info(fmt::format("{} {} since the last run; it is written again", (out / name).string(),
                            now == missing ? "is missing" : "has changed"));
      return std::nullopt;
    }
    return note.at("text").get<std::string>();
  } catch (const Json::exception&) {
    return std::nullopt;  // not a note of ours
  }
}

}  // namespace annulus::app
