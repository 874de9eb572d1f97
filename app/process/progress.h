#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace annulus::app {

/// Time left (s) of a step after `passed` seconds with `fraction` of it done: at first what was predicted, more and
/// more what the fraction says. NaN when nothing is known yet. `predicted`: 0 or NaN when there is no prediction.
[[nodiscard]] double time_left(double fraction, double passed, double predicted);

/// Progress of one long step on standard error: a line that rewrites itself with the time left on a terminal, plain
/// lines at the start and the end otherwise. Silent when the log is quiet.
class Progress {
 public:
  /// `predicted`: s that the step will take, if that is known.
  explicit Progress(std::string label, double predicted = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double fraction);
  void finish(const std::string& result);

 private:
  void clear_line();

  std::string label_;
  double predicted_;
  std::chrono::steady_clock::time_point start_, last_;
  bool terminal_;
  bool drawn_ = false;
};

/// Progress of many tasks of equal weight; any thread may report one as done.
class TaskProgress {
 public:
  TaskProgress(const std::string& label, std::size_t tasks) : progress_(label), tasks_(tasks) {}
  void done() {
    const std::scoped_lock lock(mutex_);
    progress_.update(static_cast<double>(++done_) / static_cast<double>(tasks_));
  }
  void finish(const std::string& result) { progress_.finish(result); }

 private:
  Progress progress_;
  std::mutex mutex_;
  std::size_t tasks_, done_ = 0;
};

/// Turns all progress off (--quiet) or on.
void show_progress(bool show);

}  // namespace annulus::app
