#pragma once

#include <filesystem>
#include <string>

/// Scripts that start the workers of a divided study (app/run/divided_study.h).
namespace annulus::app {

/// For this machine, with GNU parallel: all workers, then the results.
[[nodiscard]] std::string parallel_script(int shards);

/// For a cluster, with Slurm: a job array, a task per worker. `seconds`, `memory_MB`: predicted, of the worker that
/// takes most; three times the time and half as much memory again are asked for. NaN: not known.
[[nodiscard]] std::string slurm_script(const std::filesystem::path& folder, int shards, double seconds,
                                       double memory_MB);

}  // namespace annulus::app
