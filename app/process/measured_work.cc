#include "app/process/measured_work.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>

#include "app/process/interruption.h"
#include "core/errors.h"
#include "core/stopwatch.h"

namespace annulus::app {

namespace {

constexpr char answered = 'A', failed = 'F';

std::ptrdiff_t thread_count() {
  const std::filesystem::directory_iterator threads("/proc/self/task");
  return std::distance(begin(threads), end(threads));
}

/// OpenBLAS starts threads as it is loaded, and takes care of them where a process forks.
const std::ptrdiff_t threads_at_start = thread_count();

std::string read_all(int file) {
  const std::unique_ptr<FILE, decltype(&std::fclose)> stream(::fdopen(file, "r"), std::fclose);
  std::string text;
  char buffer[4096];
  while (const auto count = std::fread(buffer, 1, sizeof buffer, stream.get())) text.append(buffer, count);
  return text;
}

[[noreturn]] void work_and_leave(int file, const std::function<std::string()>& work) {
  // Not to be left behind by a parent that was killed.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::string message;
  try {
    message = answered + work();
  } catch (const std::exception& error) {
    message = failed + std::string(error.what());
  }
  FILE* stream = ::fdopen(file, "w");
  std::fwrite(message.data(), 1, message.size(), stream);
  std::fflush(nullptr);
  ::_exit(0);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

bool has_its_first_threads_alone() { return thread_count() <= threads_at_start + interruption_watchers(); }

MeasuredWork measured(const std::function<std::string()>& work) {
  // Locks held by a thread that does not go over would be held for ever.
  require(has_its_first_threads_alone(), "work is measured before any threads are started");
  int ends[2];
  if (::pipe(ends) != 0) throw SolverError(fmt::format("no pipe to a measured process: {}", std::strerror(errno)));
  std::fflush(nullptr);
  const Stopwatch stopwatch;
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw SolverError(fmt::format("no process to measure in: {}", std::strerror(errno)));
  }
  if (child == 0) {
    ::close(ends[0]);
    work_and_leave(ends[1], work);
  }
  ::close(ends[1]);
  const std::string message = read_all(ends[0]);
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  MeasuredWork result;
  result.cost = {stopwatch.seconds(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
                 static_cast<double>(usage.ru_maxrss) / 1024};
  if (!message.empty() && message.front() == answered && WIFEXITED(status)) {
    result.answer = message.substr(1);
  } else if (!message.empty() && message.front() == failed) {
    result.failure = message.substr(1);
  } else {
    result.failure = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL
                         ? "the process was killed, most likely for lack of memory"
                         : "the process ended without an answer";
  }
  return result;
}

}  // namespace annulus::app
