#include "app/process/interruption.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <thread>

namespace annulus::app {

namespace {
std::atomic<int> watchers{0};
}

void watch_for_interruption(int exit_status) {
  if (watchers++ > 0) return;
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals, exit_status] {
    int signal = 0;
    while (::sigwait(&signals, &signal) != 0) {
    }
    constexpr char text[] = "\ninterrupted; finished results are stored and reused by the next run\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, sizeof text - 1);
    std::_Exit(exit_status);
  }).detach();
}

int interruption_watchers() { return watchers; }

}  // namespace annulus::app
