#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "app/cli.h"

namespace {

/// Before any library starts threads: none of them is to take the signals that interruption.h waits for. OpenBLAS
/// starts its own as it is loaded, before main() and before all constructors of this program.
void hold_signals_back() {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &signals, nullptr);
  // Beyond the limit of the file size (ulimit -f) writing fails, with a message, as it does on a full disk.
  ::signal(SIGXFSZ, SIG_IGN);
}

/// A thread of OpenBLAS that is refused its buffer (ulimit -v) asks for it again for ever, and the end of the program
/// would wait for it. annulus uses threads of its own. The C library has not taken over the environment yet: it is
/// changed for the program started again.
void start_no_blas_threads_in_little_space(char** arguments, char** environment) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  static char one_thread[] = "OPENBLAS_NUM_THREADS=1";
  std::size_t count = 0;
  for (char** variable = environment; *variable != nullptr; ++variable, ++count)
    if (std::strcmp(*variable, one_thread) == 0) return;
  auto* changed = static_cast<char**>(std::calloc(count + 2, sizeof(char*)));
  if (changed == nullptr) return;
  changed[0] = one_thread;  // the first of a name counts
  std::copy(environment, environment + count, changed + 1);
  ::execve("/proc/self/exe", arguments, changed);
}

void before_libraries(int, char** arguments, char** environment) {
  hold_signals_back();
  start_no_blas_threads_in_little_space(arguments, environment);
}

[[gnu::section(".preinit_array"), gnu::used]] void (*const run_before_libraries)(int, char**,
                                                                                 char**) = before_libraries;

}  // namespace

int main(int argc, char** argv) { return annulus::app::run_command_line(argc, argv); }
