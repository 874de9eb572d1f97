#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.h"

namespace annulus::log {

enum class Level { quiet, normal, verbose };

/// All messages go to standard error, coloured on a terminal unless NO_COLOR is set; results go to files and standard
/// output.
void set_level(Level level);
void info(const std::string& message);
void debug(const std::string& message);
void warn(const std::string& message);
void error(const std::string& message);  ///< what ends the program
/// All messages so far, a line each.
[[nodiscard]] std::string recorded();

}  // namespace annulus::log

namespace annulus {

/// Wall time per named stage, accumulated over repeated entries; whatever is in no stage is "other". Stages may nest
/// (the inner time then counts in both), but all scopes of one object belong to one thread.
class StageTimers {
 public:
  class Scope {
   public:
    Scope(StageTimers& timers, std::string stage);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageTimers& timers_;
    std::string stage_;
    Stopwatch watch_;
  };

  [[nodiscard]] Scope measure(std::string stage) { return {*this, std::move(stage)}; }
  [[nodiscard]] double seconds(const std::string& stage) const;
  /// Stages in order of first entry, then "other" and "total".
  [[nodiscard]] std::vector<std::pair<std::string, double>> report() const;

 private:
  std::vector<std::pair<std::string, double>> stages_;
  int open_ = 0;        ///< scopes now open
  double covered_ = 0;  ///< s, during which at least one scope was open
  Stopwatch watch_;
};

/// Peak resident memory of this process in megabytes (10^6 bytes).
[[nodiscard]] double peak_memory_MB();

}  // namespace annulus
