#include "app/run/finished_run.h"

#include <fmt/format.h>

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

/// Of a result; "missing" where there is no such file. A pipe, which would have to be waited for, is none.
std::string stamp(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::is_regular_file(file, none) ? file_checksum(file).value_or(missing) : missing;
}

/// The note in OUT, without its checksum. Throws Error telling what is wrong with it; nothing where there is none.
std::optional<Json> read_note(const std::filesystem::path& out) {
  const auto file = out / note_name;
  std::error_code none;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, none))) return std::nullopt;
  const auto damaged = [] { return Error(fmt::format("{} is damaged", note_name)); };
  if (!std::filesystem::is_regular_file(file, none)) throw Error(fmt::format("{} is not a file", note_name));
  auto note = Json::parse(read_file(file), nullptr, false);
  const auto& checksum = member(note, "checksum");
  if (!checksum.is_string() || !member(note, "files").is_object() || !member(note, "text").is_string()) throw damaged();
  const std::string stated = checksum;
  note.erase("checksum");
  if (stated != text_checksum(text_of(note))) throw damaged();
  return note;
}

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
  for (const auto& name : files) id.add(name, file_checksum(scene.file.parent_path() / name).value_or(missing));
  return id.id();
}

void keep_finished_run(const std::filesystem::path& out, const std::string& id, const std::string& text,
                       const std::vector<std::string>& files) {
  Json note = {{"annulus_version", version()}, {"inputs_id", id}, {"text", text}};
  note["files"] = Json::object();
  for (const auto& file : files) note["files"][file] = stamp(out / file);
  note["checksum"] = text_checksum(text_of(note));
  write_file(out / note_name, text_of(note));
}

std::optional<std::string> why_unfinished(const std::filesystem::path& out) {
  try {
    const auto note = read_note(out);
    if (!note) return fmt::format("no {}", note_name);
    for (const auto& [name, kept] : note->at("files").items()) {
      const auto now = stamp(out / name);
      if (now != missing && now != kept) return name + " has changed since";
    }
  } catch (const Error& error) {
    return error.what();
  }
  return std::nullopt;
}

void refuse_altered_result(const std::filesystem::path& file) {
  const auto whole = std::filesystem::absolute(file).lexically_normal();
  constexpr int deepest = 8;  // folders below OUT
  auto out = whole.parent_path();
  for (int i = 0; i < deepest && !std::filesystem::exists(out / note_name); ++i) out = out.parent_path();
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        fmt::format("{}: {}; run the scene again to restore it, or copy it to another folder to use it as a file of "
                    "your own",
                    file.string(), why));
  };
  std::optional<Json> note;
  try {
    note = read_note(out);
  } catch (const Error& error) {
    refuse(
        fmt::format("{} in {}, so that it is not known whether it is as its run left it", error.what(), out.string()));
  }
  if (!note) return;
  const auto& kept = member(note->at("files"), whole.lexically_relative(out).generic_string());
  if (!kept.is_null() && kept != stamp(whole)) refuse("has changed since the run that wrote it");
}

std::optional<std::string> finished_run(const std::filesystem::path& out, const std::string& id) {
  const auto again = [&](const std::filesystem::path& file, const std::string& what) {
    log::info(fmt::format("{} {} since the last run; it is written again", file.string(), what));
  };
  std::optional<Json> note;
  try {
    note = read_note(out);
  } catch (const Error&) {
    again(out / note_name, "has changed");
    return std::nullopt;
  }
  if (!note || member(*note, "inputs_id") != id) return std::nullopt;
  for (const auto& [name, kept] : note->at("files").items()) {
    const auto now = stamp(out / name);
    if (now == kept) continue;
    again(out / name, now == missing ? "is missing" : "has changed");
    return std::nullopt;
  }
  return note->at("text").get<std::string>();
}

}  // namespace annulus::app
