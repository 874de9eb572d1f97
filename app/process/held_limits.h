#pragma once

#include <limits>
#include <stdexcept>
#include <string>

namespace annulus::app {

/// What a run must not exceed while it runs.
struct HeldLimits {
  double memory_MB = std::numeric_limits<double>::infinity();  ///< peak of the process and of those that it measured
  double seconds = std::numeric_limits<double>::infinity();    ///< wall, from hold_limits() on
  std::string stored{};                                        ///< folder in which finished results are
};

/// A limit that a run has reached, or would reach next. Exit status 4; finished results are stored. No Error: a study
/// goes on after points that cannot be computed, and must not go on after this.
class LimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From here on the thread that waits for interruptions ends the process, with a line on the standard error, as soon as
/// it finds a limit exceeded: it looks fifty times a second, whatever the process is computing. Throws LimitError when
/// one is exceeded already.
void hold_limits(const HeldLimits& limits);

/// Throws LimitError where what comes next is predicted to need more than the held memory (MB). `step` names it, and
/// `remedy` says how to need less.
void check_held_memory(double predicted_MB, const std::string& step, const std::string& remedy);

/// What the process does now, for the message of a limit.
void set_running_step(const std::string& label);

/// Of the thread that waits for interruptions: the message when a limit is exceeded, empty otherwise.
[[nodiscard]] std::string exceeded_limit();

}  // namespace annulus::app
