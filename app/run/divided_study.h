#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/model/run_options.h"
#include "app/scene/scene.h"

/// The studies of a scene on many machines that share a folder. Slurm or GNU parallel start the workers; this gives
/// each of them its share and merges what they found. Searches are not shared out: all workers compute the points of
/// every generation together. All results are cached by their content: a worker that was killed
/// goes on where it was, and one that runs twice computes nothing twice.
///
///     FOLDER/scene.toml     the scene with its files, as it was planned
///     FOLDER/points.csv     the parts of the studies with their predicted times
///     FOLDER/study.sh       starts the workers on this machine, with GNU parallel
///     FOLDER/study.sbatch   starts them on a cluster, with Slurm
///     FOLDER/cache          results that all workers need: superelements, tables, motions of the scene itself
///     FOLDER/packs/<i>_of_<n>   results of a worker
///     FOLDER/results        of the merged run
namespace annulus::app {

/// From "3/7". Throws InputError.
[[nodiscard]] Worker worker_of(const std::string& text);

/// Throws InputError where a run would write into the folder of a planned study.
void refuse_planned_study(const std::filesystem::path& out);

/// Writes scene, parts and scripts. Returns what to do next, for people. Throws InputError for a scene without studies.
std::string plan_study(const Scene& scene, const std::filesystem::path& folder, int shards);

/// Computes the parts of a worker that nobody has computed yet. Returns what it did, for people.
std::string run_shard(const std::filesystem::path& folder, const Worker& worker, const RunOptions& options);

/// The planned scene, and the options of the run that merges: it finds all parts. Throws Error naming those that are
/// missing.
struct Collected {
  Scene scene;
  RunOptions options;
};
[[nodiscard]] Collected collect_study(const std::filesystem::path& folder, const RunOptions& options);

}  // namespace annulus::app
