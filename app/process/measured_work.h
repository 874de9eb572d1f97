#pragma once

#include <functional>
#include <string>

namespace annulus::app {

/// What a piece of work cost.
struct Cost {
  double wall = 0, processor = 0;  ///< s
  double peak_memory_MB = 0;       ///< of its process, the program itself included
};

struct MeasuredWork {
  Cost cost;
  std::string answer;   ///< what the work returned
  std::string failure;  ///< why it did not; empty when it did
};

/// Whether this process has started no threads but those its libraries had when it began.
[[nodiscard]] bool has_its_first_threads_alone();

/// Runs `work` in a process of its own, so that its memory is its own and nothing it does or suffers (running out of
/// memory included) touches this one. To be called before this process starts threads: only the calling one goes over
/// into the new process. Throws SolverError when no process can be started.
[[nodiscard]] MeasuredWork measured(const std::function<std::string()>& work);

}  // namespace annulus::app
