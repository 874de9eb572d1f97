#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/figure.h"

namespace annulus::random {

/// What came of a run of the program on a scene.
enum class Outcome {
  right,
  refused,
  too_expensive,  ///< predicted
  over_limit,     ///< ended by the limit that the prediction had kept
  failed,
  crashed,
  timed_out
};
[[nodiscard]] const char* outcome_text(Outcome outcome);

/// A result as the summary states it; natural frequencies by their order. NaN: not stated.
struct StatedResult {
  std::string variant, key;
  double value = not_known, error = not_known;
  double model_error = 0, motion_error = 0;  ///< parts of the error: choice of the model, time integration

  [[nodiscard]] double numerical_error() const { return error - model_error; }
};

struct Cost {
  std::uint64_t seed = 0;
  double predicted_seconds = not_known, actual_seconds = not_known;  ///< of processor, with one thread
  double predicted_MB = not_known, actual_MB = not_known;
};

struct SceneRun {
  Outcome outcome = Outcome::failed;
  std::string message;  ///< of the program, where it is not right
  std::vector<StatedResult> results;
  Cost cost;

  /// nullptr when it is not there.
  [[nodiscard]] const StatedResult* find(const StatedResult& other) const;
};

struct RunSettings {
  std::string program;                                       ///< annulus
  std::string arguments = "";                                ///< beside those of every run
  int seconds = 300;                                         ///< until it is ended
  bool fresh = true;                                         ///< without what an earlier run in the same folder cached
  std::string max_time = "1h";                               ///< predicted
  std::vector<std::pair<std::string, std::string>> files{};  ///< beside the scene: their names and texts
};

/// Writes the scene into `folder` and runs the program on it, one thread unless the arguments say otherwise.
[[nodiscard]] SceneRun run_scene(const std::string& toml, const std::filesystem::path& folder,
                                 const RunSettings& settings);

}  // namespace annulus::random
