#include "app/process/interruption.h"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>

#include "app/process/held_limits.h"

namespace annulus::app {

namespace {
std::atomic<int> watchers{0};
}

void watch_for_interruption(int interrupted_status, int limit_status) {
  if (watchers++ > 0) return;
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals, interrupted_status, limit_status] {
    constexpr timespec moment{0, 20'000'000};
    while (::sigtimedwait(&signals, nullptr, &moment) < 0)
      if (auto exceeded = exceeded_limit(); !exceeded.empty()) {
        exceeded = fmt::format("\n{}\n", exceeded);
        [[maybe_unused]] const auto written = ::write(STDERR_FILENO, exceeded.data(), exceeded.size());
        std::_Exit(limit_status);
      }
    constexpr char text[] = "\ninterrupted; finished results are stored and reused by the next run\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, sizeof text - 1);
    std::_Exit(interrupted_status);
  }).detach();
}

int interruption_watchers() { return watchers; }

}  // namespace annulus::app
