#include "app/run/study_scripts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace annulus::app {

namespace {

/// For a shell.
std::string quoted(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string parallel_script(int shards) {
  return fmt::format(R"sh(#!/bin/sh
# All parts of the study on this machine, as many workers at once as it has cores (JOBS=2: two), then the results.
cd "$(dirname "$0")" || exit 1
parallel --jobs "${{JOBS:-100%}}" "${{ANNULUS:-annulus}}" study run . --shard {{}}/{0} --threads 1 ::: $(seq {0}) &&
  "${{ANNULUS:-annulus}}" study collect .
)sh",
                     shards);
}

std::string slurm_script(const std::filesystem::path& folder, int shards, double seconds, double memory_MB) {
  constexpr double room = 3, least_minutes = 10;
  const double minutes = std::ceil(std::max(least_minutes, std::isfinite(seconds) ? room * seconds / 60 : 0.0));
  std::string memory;
  if (std::isfinite(memory_MB)) memory = fmt::format("#SBATCH --mem={:.0f}M\n", std::ceil(1.5 * memory_MB) + 200);
  return fmt::format(R"sh(#!/bin/bash
# A worker per task; when all have ended: annulus study collect FOLDER
#SBATCH --job-name=annulus
#SBATCH --array=1-{0}
#SBATCH --cpus-per-task=1
#SBATCH --time={1:.0f}
#SBATCH --output=/dev/null
{2}cd {3} || exit 1
exec "${{ANNULUS:-annulus}}" study run . --shard "$SLURM_ARRAY_TASK_ID/{0}" \
  --threads "${{SLURM_CPUS_PER_TASK:-1}}" > "logs/$SLURM_ARRAY_TASK_ID.log" 2>&1
)sh",
                     shards, minutes, memory, quoted(std::filesystem::absolute(folder).lexically_normal()));
}

}  // namespace annulus::app
