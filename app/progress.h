#pragma once

#include <chrono>
#include <string>

namespace annulus::app {

/// Progress of one long step on standard error: a line that rewrites itself with the time left on a terminal, plain
/// lines at the start and the end otherwise. Silent when the log is quiet.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double fraction);
  void finish(const std::string& result);

 private:
  void clear_line();

  std::string label_;
  std::chrono::steady_clock::time_point start_, last_;
  bool terminal_;
  bool drawn_ = false;
};

/// Turns all progress off (--quiet) or on.
void show_progress(bool show);

}  // namespace annulus::app
