#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/figure.h"

namespace annulus::app {

/// A variant of a finished run with its figures; a scene without variants has one, or two where it compares given with
/// computed stiffness.
struct ComparedVariant {
  std::string name{};                           ///< of the run, and of the variant where a run has several
  FigureSet figures{};                          ///< SI
  std::map<std::string, std::string> inputs{};  ///< by key, as in a scene file
};

/// What a finished run says of itself in summary.json.
struct ComparedRun {
  std::filesystem::path folder{};
  std::string name{}, title{}, version{}, kind{};
  double accuracy = 0;
  const std::vector<FigureSpec>* specs = nullptr;  ///< results of runs of this kind
  std::vector<ComparedVariant> variants{};
  std::vector<std::pair<std::string, double>> timings{};  ///< s
  double peak_memory_MB = 0;
  std::size_t read_back = 0;  ///< results that were reused and cost no time
};

/// The finished runs in these folders, named by their folders as shortly as they differ. Throws InputError with
/// place and remedy: fewer than two folders or one twice; no such folder; no finished run in it; a summary that cannot
/// be read, is not one of annulus, or of another kind of stage than the first.
[[nodiscard]] std::vector<ComparedRun> read_finished_runs(const std::vector<std::string>& folders);

}  // namespace annulus::app
