#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/json.h"

namespace annulus::app {

struct RunOptions;

enum class ResultSource { computed, reused };
[[nodiscard]] inline ResultSource source_of(bool reused) {
  return reused ? ResultSource::reused : ResultSource::computed;
}

/// What a run took from earlier ones and what it computed itself. Any number of threads at once.
class Reuse {
 public:
  /// A result of its own: "sun-planet mesh", "dynamics of 'pinned'".
  void note(const std::string& result, ResultSource source);
  /// Things that are counted: "tooth superelements", "responses of studies".
  void count(const std::string& things, long reused, long computed);

  /// In alphabetical order, however threads came.
  [[nodiscard]] std::vector<std::string> reused() const { return list(ResultSource::reused); }
  [[nodiscard]] std::vector<std::string> computed() const { return list(ResultSource::computed); }
  struct Count {
    long reused = 0, computed = 0;
  };
  [[nodiscard]] Count counted(const std::string& things) const;
  [[nodiscard]] std::map<std::string, Count> counts() const;

  /// Lines for people; empty when nothing was noted.
  [[nodiscard]] std::string text() const;
  /// {"reused": [...], "computed": [...], "counts": {...}}
  [[nodiscard]] Json json() const;

 private:
  [[nodiscard]] std::vector<std::string> list(ResultSource source) const;

  mutable std::mutex lock_;
  std::map<std::string, ResultSource> results_;
  std::map<std::string, Count> counts_;
};

inline constexpr const char *condensed_teeth = "tooth superelements", *study_meshes = "meshes of studies",
                            *study_responses = "responses of studies", *search_evaluations = "evaluations of searches";

/// Where the run notes its reuse: a result of its own, or one of those that a study counts.
void note_reuse(const RunOptions& options, const std::string& result, ResultSource source);
void count_reuse(const RunOptions& options, const std::string& things, long reused, long computed);

/// The options of a run that notes its reuse and caches its results.
[[nodiscard]] RunOptions with_reuse(const RunOptions& options);

}  // namespace annulus::app
