#pragma once

namespace annulus::app {

/// From here on SIGINT and SIGTERM end the process at once with `interrupted_status` and a line on the standard error.
/// Nothing needs cleaning up: every file is written under another name and renamed (core/files.h), so that finished
/// results are there for the next run. To be called by main before any thread is started.
///
/// The same thread holds the limits of a run (held_limits.h), whose exit status is `limit_status`.
///
/// The signals are blocked in all threads and waited for in one of their own: METIS puts its own handler in the place
/// of a program's while it orders a matrix, and takes a SIGTERM for its lack of memory.
void watch_for_interruption(int interrupted_status, int limit_status);

/// Threads that wait for signals: 0 or 1.
[[nodiscard]] int interruption_watchers();

}  // namespace annulus::app
