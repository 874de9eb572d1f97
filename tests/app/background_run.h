#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

namespace annulus::test {

/// `annulus run scene.toml -o OUT` in a folder, as a process that can be killed.
class BackgroundRun {
 public:
  BackgroundRun(const std::filesystem::path& folder, const std::string& out, int threads = 2) : process_(::fork()) {
    if (process_ != 0) return;
    const std::string count = std::to_string(threads);
    ::setenv("ANNULUS_CACHE", "", 1);  // cached in OUT/cache
    if (::chdir(folder.c_str()) == 0)
      ::execl(ANNULUS_PROGRAM, ANNULUS_PROGRAM, "run", "scene.toml", "-q", "-o", out.c_str(), "--threads",
              count.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }

  /// Status as of waitpid.
  int wait() const {
    int status = 0;
    ::waitpid(process_, &status, 0);
    return status;
  }

  /// Killed, not asked to stop, as soon as the file or folder is there (or after a minute); whether it was still
  /// running.
  [[nodiscard]] bool kill_when_there(const std::filesystem::path& file) const {
    for (int i = 0; i < 12000 && !std::filesystem::exists(file); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(process_, SIGKILL);
    return WIFSIGNALED(wait());
  }

 private:
  pid_t process_;
};

}  // namespace annulus::test
