#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace annulus::app {

struct RunOptions;
struct Scene;

/// What all results of a run depend on: inputs with their origins, whatever else the scene file says, the content of
/// the files it names, and the program itself.
[[nodiscard]] std::string run_id(const Scene& scene, const RunOptions& options);

/// Notes in OUT/run.json that the run of this identity ended with `text`, and size and checksum of the files it left,
/// named relative to OUT, and of the note itself.
void keep_finished_run(const std::filesystem::path& out, const std::string& id, const std::string& text,
                       const std::vector<std::string>& files);

/// The text of the run of this identity if every file it left is as it was; then nothing is to be done again. Nothing
/// else is read: a run that only looks takes a fraction of a second whatever the size of its results.
[[nodiscard]] std::optional<std::string> finished_run(const std::filesystem::path& out, const std::string& id);

/// Why OUT does not hold the results of one whole run: none has ended there, or a later one has begun to change its
/// files. Files may have been copied, with new times, or removed. Nothing when it does.
[[nodiscard]] std::optional<std::string> why_unfinished(const std::filesystem::path& out);

/// Throws InputError when the file is a result of a run and not as that run left it: its values are not those of the
/// scene. A copy elsewhere is a file of the user's own.
void refuse_altered_result(const std::filesystem::path& file);

}  // namespace annulus::app
